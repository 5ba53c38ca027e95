# SPDX-License-Identifier: Apache-2.0
"""What modelling a feature costs: kernels from which one NEED flag is taken are compiled and timed beside those that have it.
Of a flag that the scene needs that leaves its work out, and the picture is wrong; any other is taken from kernels with every
feature, and the picture stays. (Adding one alone would need queues that the host doesn't make.) Renders take turns, whichever
comes second is no slower for it. What other programs do to the machine lengthens times: processor time counts, by the median of
the pairs' ratios, and of the stages, whose processor time nobody tells, the shortest time."""

import json
import math
import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Small scenes without textures, and one that needs most features.
SMALL = ["cornell", "sphere", "furnace", "planes", "wall"]
LARGE = "kitchen"
PICTURE = ["--width", "400", "--height", "300", "--spp", "4"]
STAGES = ["shade", "shadow", "obscurance", "gather"]  # those that hold the features

# Of each feature a scene that needs it and one that doesn't, with options of render where those decide.
CORNELL, PLANES, KITCHEN = ("cornell", []), ("planes", []), ("kitchen", [])
FEATURES = {
    "textures": (KITCHEN, CORNELL),
    "smooth_normals": (KITCHEN, CORNELL),
    "glossy": (KITCHEN, CORNELL),
    "mirror": (KITCHEN, CORNELL),
    "transmission": (KITCHEN, CORNELL),
    "area_lights": (CORNELL, PLANES),
    "point_lights": (("cornell + point", []), CORNELL),
    "spot_lights": (("cornell + spot", []), CORNELL),
    "directional_lights": (("cornell + directional", []), CORNELL),
    "emission": (CORNELL, PLANES),
    "background": (PLANES, CORNELL),
    "bleeding": (CORNELL, ("cornell", ["--bleeding", "off"])),
    "obscurance": (CORNELL, ("cornell", ["--ambient", "constant"])),
    "ambient": (CORNELL, ("cornell", ["--ambient", "none"])),
    "specular_paths": (KITCHEN, CORNELL),
}
# The step asks whether there is any hit; other falloffs how far the nearest is, and with bleeding of which colour.
ANY_HIT = ["--rho", "step", "--bleeding", "off"]
OBSCURANCES = {"step, bleeding": ["--rho", "step"], "sqrt, no bleeding": ["--rho", "sqrt", "--bleeding", "off"],
               "sqrt, bleeding": ["--rho", "sqrt"], "exp, bleeding": ["--rho", "exp"]}


def all_flags():
    text = (ROOT / "kernels/lib/features.clh").read_text(encoding="utf-8")
    return [name.lower() for name in re.findall(r"^#ifndef NEED_(\w+)$", text, re.MULTILINE)]


def flags():
    """Names as obscura info prints them; falloffs are no flags there."""
    return [name for name in all_flags() if not name.startswith("falloff")]


def kernels_without(lacking, folder):
    """A copy of the kernels that lacks these features, whatever the build options say."""
    kernels = pathlib.Path(folder) / "kernels"
    shutil.copytree(ROOT / "kernels", kernels)
    features = kernels / "lib/features.clh"
    text = features.read_text(encoding="utf-8")
    for flag in lacking:
        guard = f"#ifndef NEED_{flag.upper()}\n"
        if guard not in text:
            sys.exit(f"tools/report: kernels/lib/features.clh has no {guard.strip()} any more")
        text = text.replace(guard, f"#undef NEED_{flag.upper()}\n#define NEED_{flag.upper()} 0\n{guard}")
    features.write_text(text, encoding="utf-8")
    return kernels


def scene_path(scene, folder):
    """"name" is of scenes/; "name + kind" is that with a punctual light, which shines into the open front of the Cornell box."""
    name, _, kind = scene.partition(" + ")
    if not kind:
        return ROOT / "scenes" / name
    model = json.loads((ROOT / "scenes" / name / f"{name}.gltf").read_text(encoding="utf-8"))
    light = {"type": kind, "intensity": 10, **({"spot": {"outerConeAngle": 1}} if kind == "spot" else {})}
    model.setdefault("extensions", {})["KHR_lights_punctual"] = {"lights": [light]}
    model["extensionsUsed"].append("KHR_lights_punctual")
    model["scenes"][0]["nodes"].append(len(model["nodes"]))
    model["nodes"].append({"name": "Punctual light", "translation": [2.78, 2.73, 0.5], "rotation": [0, 1, 0, 0],
                           "extensions": {"KHR_lights_punctual": {"light": 0}}})
    path = pathlib.Path(folder) / f"{kind}.gltf"
    path.write_text(json.dumps(model), encoding="utf-8")
    return path


def run(command, environment):
    """Standard output of a command, and the processor time that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, env={**os.environ, **environment},
                          check=False)
    if done.returncode != 0:
        sys.exit(f"tools/report: {done.stderr.strip()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(done.stdout), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def median_with_interval(values):
    """With the values between which the median lies with 95 % confidence (binomial, in normal approximation)."""
    ordered = sorted(values)
    rank = max(0, math.floor((len(ordered) - 1.96 * math.sqrt(len(ordered))) / 2) - 1)
    return [statistics.median(ordered), ordered[rank], ordered[-1 - rank]]


class Variant:
    """A scene rendered with these options and kernels, which are kept compiled. lacking: None for the program's own kernels, which
    don't compare with those of a folder: reading these takes time."""

    def __init__(self, program, scene, options, lacking, folder):
        folder.mkdir()
        self.caches = folder / "caches"
        kernels = {"OBSCURA_KERNEL_DIR": str(kernels_without(lacking, folder))} if lacking is not None else {}
        self.environment = {"OBSCURA_CACHE_DIR": str(self.caches), "POCL_CACHE_DIR": str(folder / "pocl"), **kernels}
        self.command = [program, "render", scene_path(scene, folder), *PICTURE, *options, "-o", folder / "x.exr", "--stats", "-",
                        "--quiet"]
        stats, cold = run(self.command, self.environment)
        self.needs = stats["needs"]
        self.device = f"{stats['device']}, driver {stats['driver']}"
        _, warm = run(self.command, self.environment)
        self.cost = {"compile_cpu_seconds": cold - warm,
                     "bytes": sum(file.stat().st_size for file in self.caches.rglob("*") if file.is_file())}

    def times(self):
        """Seconds of processor time of a render, nanoseconds per item of the stages."""
        stats, cpu_seconds = run(self.command, self.environment)
        kernels = stats["kernels"]
        return {"cpu": cpu_seconds, **{stage: 1e6 * kernels[stage]["ms"] / kernels[stage]["items"]
                                       for stage in STAGES if kernels.get(stage, {}).get("items")}}


class Pricer:
    def __init__(self, program, repeats, folder):
        self.program, self.repeats, self.folder = program, repeats, pathlib.Path(folder)
        self.variants = {}

    def variant(self, scene, options, lacking=None):
        key = (scene, tuple(options), None if lacking is None else tuple(lacking))
        if key not in self.variants:
            print(", ".join([scene, " ".join(options), *(f"no {flag}" for flag in lacking or [])]), file=sys.stderr)
            self.variants[key] = Variant(self.program, scene, options, lacking, self.folder / str(len(self.variants)))
        return self.variants[key]

    def compare(self, base, other):
        """What compiling takes and makes of both variants, the ratio of their processor times, the shortest times of stages."""
        pairs = []
        for repeat in range(self.repeats):
            order = [base, other] if repeat % 2 else [other, base]
            times = {id(variant): variant.times() for variant in order}
            pairs.append((times[id(base)], times[id(other)]))
        shortest = [{stage: min(pair[which][stage] for pair in pairs) for stage in STAGES if stage in pairs[0][which]}
                    for which in (0, 1)]
        return {"base": {**base.cost, "ns": shortest[0]}, "other": {**other.cost, "ns": shortest[1]},
                "cpu_ratio": median_with_interval(pair[1]["cpu"] / pair[0]["cpu"] for pair in pairs)}

    def price_flag(self, flag, needed):
        scene, options = FEATURES[flag][0 if needed else 1]
        plain = self.variant(scene, options)
        if (flag in plain.needs) != needed:
            sys.exit(f"tools/report: {scene} {' '.join(options)} {'needs no' if needed else 'needs'} {flag}")
        options = options if needed else [*options, "--needs", "all"]
        return {"feature": flag, "needed": needed, "scene": " ".join([scene, *FEATURES[flag][0 if needed else 1][1]]),
                **self.compare(self.variant(scene, options, [flag]), self.variant(scene, options, []))}

    def price_falloffs(self):
        scene, options = CORNELL[0], [*CORNELL[1], "--needs", "all"]
        others = [flag for flag in all_flags() if flag.startswith("falloff") and flag != "falloff_exp"]
        return {"feature": "falloffs besides exp", "needed": False, "scene": scene,
                **self.compare(self.variant(scene, options, others), self.variant(scene, options, []))}

    def price_all(self, scene):
        return {"scene": scene, **self.compare(self.variant(scene, []), self.variant(scene, ["--needs", "all"]))}

    def price_obscurance(self, name):
        return {"obscurances": name, **self.compare(self.variant(LARGE, ANY_HIT), self.variant(LARGE, OBSCURANCES[name]))}


def change(ratio):
    return f"{100 * (ratio - 1):+.1f}".replace("-", "−")


def stage_cell(row, stage):
    values = [row[which]["ns"].get(stage) for which in ("base", "other")]
    if values == [None, None]:
        return "–"
    return " to ".join("–" if value is None else f"{value:.0f}" for value in values)


def cells(row):
    base, other = row["base"], row["other"]
    median, low, high = row["cpu_ratio"]
    return [f"{other['compile_cpu_seconds'] - base['compile_cpu_seconds']:+.1f}".replace("-", "−"),
            f"{(other['bytes'] - base['bytes']) / 1024:+.0f}".replace("-", "−"),
            f"{change(median)} ({change(low)} to {change(high)})", *(stage_cell(row, stage) for stage in STAGES)]


def tables(prices):
    """Of each table its title, a note, the head and the rows."""
    columns = ["compiling, s", "programs, KiB", "processor time, %", *(f"{stage}, ns" for stage in STAGES)]
    return [
        ("Everything (--needs all) beside what the scene needs", "", ["scene", *columns],
         [[row["scene"], *cells(row)] for row in prices["all"]]),
        ("One feature beside the same kernels without it",
         "Where it is needed, beside the others that the scene needs and with its work; else beside all others and without work.",
         ["feature", "needed", "scene", *columns],
         [[row["feature"], "yes" if row["needed"] else "no", row["scene"], *cells(row)] for row in prices["flags"]]),
        (f"Obscurances of the {LARGE} beside ambient occlusion (the step without bleeding), which takes any hit", "",
         ["obscurances", *columns], [[row["obscurances"], *cells(row)] for row in prices["obscurances"]])]


def description(prices):
    return (f"tools/report needs --repeats {prices['repeats']} on {prices['device']}: pairs of renders with {' '.join(PICTURE)}. "
            "Compiling: processor time added when all kernels are cold. Programs: their added size. Processor time: what is added to "
            "that of a whole render with compiled kernels, the median of the pairs and the interval in which it lies with 95 % "
            "confidence. Stages: the shortest time per item without and with it.")


def markdown(prices):
    lines = ["## What features cost", "", description(prices)]
    for title, note, head, rows in tables(prices):
        lines += ["", f"### {title}", "", *([note, ""] if note else []),
                  *("| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *rows])]
    return "\n".join(lines) + "\n"


def measure(program, repeats):
    with tempfile.TemporaryDirectory() as folder:
        pricer = Pricer(program, repeats, folder)
        return {"repeats": repeats, "device": pricer.variant(*CORNELL).device,
                "all": [pricer.price_all(scene) for scene in [*SMALL, LARGE]],
                "flags": [*(pricer.price_flag(flag, needed) for flag in flags() for needed in (True, False)), pricer.price_falloffs()],
                "obscurances": [pricer.price_obscurance(name) for name in OBSCURANCES]}
