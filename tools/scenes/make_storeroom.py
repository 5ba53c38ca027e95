#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a storeroom of about as many triangles as wanted, from 30 thousand to 20 million: the same room at each size, made of
finer pieces and more of them. Equal bytes on every run. Needs numpy."""

import argparse
import pathlib
import sys

from modelling.gltf import Scene
from modelling.surface import Model
from storeroom import room, things

LEAST, MOST = 30_000, 20_000_000


def storeroom(triangles):
    scene = Scene("Storeroom")
    pieces = room.pieces(triangles)
    for piece, level in zip(pieces, room.levels(pieces, triangles)):
        scene.add(piece.name, Model.of_mesh(piece.material, piece.shape.mesh(level)), piece.at, piece.turn)
    for light in room.lights():
        scene.add("Light", Model.of_mesh(things.LIGHT, light.mesh(1)))
    scene.camera("Camera", room.EYE, room.TARGET, 52.0)
    return scene


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--triangles", type=int, default=LEAST, help="about so many (default: 30000)")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="default: build/storeroom-TRIANGLES.glb")
    options = parser.parse_args()
    if not LEAST <= options.triangles <= MOST:
        parser.error(f"--triangles {options.triangles}: {LEAST} to {MOST} can be made")
    output = options.output or root / "build" / f"storeroom-{options.triangles}.glb"
    scene = storeroom(options.triangles)
    output.parent.mkdir(parents=True, exist_ok=True)
    size = scene.write(output)
    objects, triangles = scene.counts()
    print(f"{output}: {objects} objects, {triangles} triangles, {size} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
