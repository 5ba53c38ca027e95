#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks `obscura info` against an independent computation of A_T, R_ave and I_A.

    tools/check_radiometry.py build/obscura scenes/kitchen [more scenes]

Shares nothing with the program but the definitions in host/scene/*.h: its own glTF reader, PNG decoder,
albedo quadrature (over microfacet normals instead of directions), texture means (by samples instead of
integrals) and silhouettes. Exits with 0 if all scenes agree, 1 if one does not, 2 if a scene can't be read.
Needs numpy only.
"""
import json
import math
import pathlib
import subprocess
import sys

import numpy as np

from radiometry_model import Material, Texture
from radiometry_reader import Gltf, Unreadable, corner_indices, float32, uv_mapping, walk

# Relative tolerances. Float32 is what the program stores; the rest is double on both sides.
EXACT = 1e-9
ROUGH = 2e-5  # a rough specular lobe: the program's table has entries good to 1e-4, weighted by F0 = 0.04
TEXTURED = 1e-4  # sampled here
NEAREST = 1e-3  # sampled, and with jumps
DIRECTIONAL = 5e-3  # silhouettes are rasterised on both sides, on different grids


def silhouette_area(triangles, direction):
    """Area covered by the triangles (n x 3 x 3) seen along direction."""
    size = 1500
    w = direction / np.linalg.norm(direction)
    u = np.cross(w, np.eye(3)[np.argmin(np.abs(w))])
    u /= np.linalg.norm(u)
    p = triangles @ np.stack([u, np.cross(w, u)], axis=1)
    low, high = p.reshape(-1, 2).min(axis=0), p.reshape(-1, 2).max(axis=0)
    pixel = (high - low) / size
    covered = np.zeros((size, size), bool)
    p = (p - low) / pixel
    for a, b, c in p:
        x0, y0 = np.maximum(np.floor(np.minimum(np.minimum(a, b), c)).astype(int), 0)
        x1, y1 = np.minimum(np.ceil(np.maximum(np.maximum(a, b), c)).astype(int), size)
        if x1 <= x0 or y1 <= y0:
            continue
        x, y = np.meshgrid(np.arange(x0, x1) + 0.5, np.arange(y0, y1) + 0.5)
        cross = lambda s, e: (e[0] - s[0]) * (y - s[1]) - (e[1] - s[1]) * (x - s[0])
        e0, e1, e2 = cross(a, b), cross(b, c), cross(c, a)
        inside = ((e0 >= 0) & (e1 >= 0) & (e2 >= 0)) | ((e0 <= 0) & (e1 <= 0) & (e2 <= 0))
        covered[y0:y1, x0:x1] |= inside
    return covered.sum() * pixel[0] * pixel[1]


def light_power(light, world, triangles):
    """Phi / pi per channel."""
    intensity = float32(np.array(light.get("color", [1, 1, 1]), float) * light.get("intensity", 1))
    if light["type"] == "point":
        return 4 * intensity
    if light["type"] == "directional":
        return intensity * silhouette_area(triangles, -world[:3, 2]) / math.pi
    spot = light.get("spot", {})
    inner = float(float32(math.cos(spot.get("innerConeAngle", 0))))
    outer = float(float32(math.cos(spot.get("outerConeAngle", math.pi / 4))))
    ramp = max(0.001, inner - outer)
    x, w = np.polynomial.legendre.leggauss(8)
    total = 0.0  # of the squared ramp over the cosine, piece by piece
    for low, high in ((outer, min(1, outer + ramp)), (min(1, outer + ramp), 1)):
        cosine = low + (high - low) * (x + 1) / 2
        total += (w / 2 * (high - low) * np.clip((cosine - outer) / ramp, 0, 1) ** 2).sum()
    return 2 * total * intensity


def compute(path):
    gltf = Gltf(path)
    materials = [Material(gltf, m) for m in gltf.json.get("materials", [])]
    default = Material(gltf, {})
    textures, rng = {}, np.random.default_rng(1)
    area, reflecting, emitted = 0.0, np.zeros(3), np.zeros(3)
    objects, count, dropped, tolerance, lamps, all_triangles = 0, 0, 0, EXACT, [], []
    for node, world in walk(gltf):
        lamp = node.get("extensions", {}).get("KHR_lights_punctual")
        if lamp:
            lamps.append((gltf.json["extensions"]["KHR_lights_punctual"]["lights"][lamp["light"]], world))
        if "mesh" not in node:
            continue
        objects += 1
        for primitive in gltf.json["meshes"][node["mesh"]]["primitives"]:
            if "POSITION" not in primitive["attributes"]:
                continue
            position = gltf.accessor(primitive["attributes"]["POSITION"])
            position = float32(position @ world[:3, :3].T + world[:3, 3])
            corners = corner_indices(primitive, gltf, len(position))
            p = position[corners]
            areas = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2
            kept = areas > 0
            dropped += int((~kept).sum())
            count += int(kept.sum())
            corners, areas = corners[kept], areas[kept]
            all_triangles.append(p[kept])
            m = materials[primitive["material"]] if "material" in primitive else default
            base = np.tile(m.base, (len(areas), 1))
            if m.texture is not None:
                texture_set, matrix, offset = uv_mapping(m.texture)
                uv = primitive["attributes"].get(f"TEXCOORD_{texture_set}")
                uv = gltf.accessor(uv) if uv is not None else np.zeros((len(position), 2))
                uv = float32(uv @ matrix.T + offset)
                index = m.texture["index"]
                if index not in textures:
                    textures[index] = Texture(gltf, index)
                base *= textures[index].means(uv[corners], rng)
                tolerance = max(tolerance, NEAREST if textures[index].nearest else TEXTURED)
            if m.rough:
                tolerance = max(tolerance, ROUGH)
            sides = areas * m.sides
            area += sides.sum() * m.opacity
            reflecting += (sides[:, None] * base * m.scale).sum(axis=0)
            emitted += sides.sum() * m.emission
    triangles = np.concatenate(all_triangles) if all_triangles else np.zeros((0, 3, 3))
    for lamp, world in lamps:
        emitted += light_power(lamp, world, triangles)
        if lamp["type"] == "directional":
            tolerance = max(tolerance, DIRECTIONAL)
    r_ave = reflecting / area if area > 0 else np.zeros(3)
    i_a = emitted / area / (1 - r_ave) if area > 0 else np.zeros(3)
    result = {"triangles": count, "dropped_triangles": dropped, "objects": objects, "area": area,
              "emitted": emitted, "R_ave": r_ave, "I_A": i_a, "I_A_colourless": r_ave * i_a}
    return result, tolerance


def scene_file(path):
    if path.is_dir():
        for extension in (".glb", ".gltf"):
            file = path / (path.resolve().name + extension)
            if file.is_file():
                return file
    return path


def check(program, scene):
    """True if the program and this script agree on the scene."""
    expected, tolerance = compute(scene_file(pathlib.Path(scene)))
    output = subprocess.run([program, "info", scene, "--json", "-"], check=True, stdout=subprocess.PIPE,
                            stderr=subprocess.DEVNULL).stdout
    found = json.loads(output)
    agree = True
    print(f"{scene} (tolerance {tolerance:g})")
    for key, value in expected.items():
        value, other = np.atleast_1d(value), np.atleast_1d(found[key])
        limit = {"triangles": 0, "dropped_triangles": 0, "objects": 0, "area": EXACT}.get(key, tolerance)
        scale = np.maximum(np.abs(value), np.abs(other))
        error = np.max(np.abs(value - other) / np.where(scale > 0, scale, 1))
        agree &= bool(error <= limit)
        mark = "ok " if error <= limit else "BAD"
        print(f"  {mark} {key:18} {'  '.join(f'{v:.10g}' for v in value):44} relative difference {error:.1e}")
    return agree


def main():
    if len(sys.argv) < 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    results = []
    for scene in sys.argv[2:]:
        try:
            results.append(check(sys.argv[1], scene))
        except Unreadable as reason:
            print(f"{scene}: this script can't read {reason}", file=sys.stderr)
            return 2
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
