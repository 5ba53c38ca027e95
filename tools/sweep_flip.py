# SPDX-License-Identifier: Apache-2.0
"""FLIP, the difference that a person sees between two pictures that alternate (Andersson et al. 2020), by its authors' package
flip_evaluator, which Debian doesn't have: without it there is no FLIP, and the page says so."""

import matplotlib.image
import numpy as np

try:
    import flip_evaluator
except ModuleNotFoundError:
    flip_evaluator = None

HOW_TO_INSTALL = "pip install flip-evaluator"
PIXELS_PER_DEGREE = 67  # FLIP's default: a display of 0.7 m and 3840 pixels, seen from 0.7 m


def read_picture(path):
    """The colours of a PNG in sRGB, from 0 to 1."""
    return np.ascontiguousarray(matplotlib.image.imread(path)[..., :3], dtype=np.float32)


def measure(folder, sweep):
    """Of each method the mean FLIP of the previews of its first seed, by budget: 0 no difference, 1 the largest. None without the
    package."""
    if flip_evaluator is None:
        return None
    paths = {name: folder / "pictures" / f"reference-{name}.png" for name in sweep["references"]}
    references = {name: read_picture(path) for name, path in paths.items() if path.exists()}
    found = {}
    for name, rows in sweep["methods"].items():
        reference = references.get(sweep["measured_against"][name])
        pictures = {row["budget"]: folder / "pictures" / f"{name}-{row['budget']}.png" for row in rows}
        found[name] = {
            budget: float(flip_evaluator.evaluate(reference, read_picture(picture), "LDR", True, False, True,
                                                  {"ppd": PIXELS_PER_DEGREE})[1])
            for budget, picture in pictures.items() if picture.exists() and reference is not None}
    return found
