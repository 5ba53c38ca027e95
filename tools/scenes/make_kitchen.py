#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes scenes/kitchen/kitchen.glb: the kitchen, 203 objects and 28 937 triangles as in Mendez, Sbert and
Neumann 2003. Run without arguments; equal bytes on every run."""

import argparse
import pathlib
import sys

from kitchen import appliances, cabinets, chairs, hob, lamp, room, shelves, sink, table, things, wall, window
from modelling.gltf import Scene

OBJECTS, TRIANGLES = 203, 28937
CAMERA = {"eye": (4.30, 1.62, 3.80), "target": (1.40, 0.95, 0.60), "vertical_fov": 48.0}
TABLE_CAMERA = {"eye": (3.62, 1.32, 3.25), "target": (2.25, 0.78, 2.1), "vertical_fov": 40.0}
MODULES = (room, window, cabinets, sink, hob, appliances, shelves, things, wall, lamp, table, chairs)


def kitchen():
    scene = Scene("Kitchen")
    for module in MODULES:
        module.build(scene)
    scene.camera("Camera", **CAMERA)
    scene.camera("Table", **TABLE_CAMERA)
    return scene


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", default=root / "scenes" / "kitchen" / "kitchen.glb", type=pathlib.Path)
    parser.add_argument("--list", action="store_true", help="print the triangles of every object")
    arguments = parser.parse_args()
    scene = kitchen()
    objects, triangles = scene.counts()
    if arguments.list:
        for name, count in scene.triangles_by_name():
            print(f"{count:6d}  {name}")
    if (objects, triangles) != (OBJECTS, TRIANGLES):
        print(
            f"The kitchen has {objects} objects and {triangles} triangles; it must have {OBJECTS} and {TRIANGLES}.",
            file=sys.stderr,
        )
        return 1
    size = scene.write(arguments.output)
    print(f"{arguments.output}: {objects} objects, {triangles} triangles, {size} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
