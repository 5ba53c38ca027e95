#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the small scenes under scenes/: cornell, furnace, planes, wall, sphere. Equal bytes on every run."""

import argparse
import pathlib

from small_scenes import FILES


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", default=root / "scenes", type=pathlib.Path, help="the folder of all scenes")
    folder = parser.parse_args().output
    for name, make in FILES.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        scene = make()
        size = scene.write(path)
        objects, triangles = scene.counts()
        print(f"{path}: {objects} objects, {triangles} triangles, {size} bytes")


if __name__ == "__main__":
    main()
