#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the scenes: the kitchen's exact counts, sound geometry, what its camera sees; that the generators still
write the committed files. Prints a summary; exit 1 on failure. Needs numpy."""

import base64
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
from dataclasses import dataclass

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES, GENERATORS = ROOT / "scenes", ROOT / "tools" / "scenes"
SMALL = {
    "cornell/cornell.gltf": 32,
    "furnace/furnace.glb": 5120,
    "planes/planes.gltf": 4,
    "wall/wall.gltf": 4,
    "sphere/sphere.glb": 5124,
}
OBJECTS, TRIANGLES, SEEN = 203, 28937, 150
# The window's niche and the door's reveal lie behind the walls; what hangs on a wall dips into it by up to 4 mm.
ROOM_LOW, ROOM_HIGH = (-0.201, -0.001, -0.004), (4.641, 2.601, 4.001)
MIN_HEIGHT = 1e-5  # metres: below this a triangle counts as degenerate
MIN_AGREEMENT = 0.2  # cosine between a corner's normal and its triangle's
failures = []


def expect(holds, message):
    if not holds:
        failures.append(message)


@dataclass
class Scene:
    points: np.ndarray  # triangle, corner, xyz
    normals: np.ndarray
    objects: np.ndarray  # per triangle
    materials: np.ndarray
    names: list
    cameras: dict  # name: (camera to world, vertical field of view)
    document: dict
    binary: bytes


def read_file(path):
    data = path.read_bytes()
    if path.suffix == ".glb":
        (json_bytes,) = struct.unpack_from("<I", data, 12)
        return json.loads(data[20 : 20 + json_bytes]), data[28 + json_bytes :]
    document = json.loads(data)
    return document, base64.b64decode(document["buffers"][0]["uri"].split(",")[1])


def node_matrix(node):
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def load(path):
    document, binary = read_file(path)

    def accessor(index):
        item = document["accessors"][index]
        view = document["bufferViews"][item["bufferView"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[item["type"]]
        kind = {5123: "<u2", 5125: "<u4", 5126: "<f4"}[item["componentType"]]
        offset = view.get("byteOffset", 0) + item.get("byteOffset", 0)
        return np.frombuffer(binary, kind, item["count"] * width, offset).reshape(-1, width)

    points, normals, objects, materials, names, cameras = [], [], [], [], [], {}

    def visit(index, parent):
        node = document["nodes"][index]
        world = parent @ node_matrix(node)
        if "camera" in node:
            cameras[node["name"]] = (world, document["cameras"][node["camera"]]["perspective"]["yfov"])
        if "mesh" in node:
            for primitive in document["meshes"][node["mesh"]]["primitives"]:
                order = accessor(primitive["indices"])[:, 0].astype(int)
                place = accessor(primitive["attributes"]["POSITION"])[order] @ world[:3, :3].T + world[:3, 3]
                direction = accessor(primitive["attributes"]["NORMAL"])[order] @ world[:3, :3].T
                points.append(place.reshape(-1, 3, 3))
                normals.append(direction.reshape(-1, 3, 3))
                objects.extend([len(names)] * (len(order) // 3))
                materials.extend([primitive["material"]] * (len(order) // 3))
            names.append(node["name"])
        for child in node.get("children", []):
            visit(child, world)

    for root in document["scenes"][document["scene"]]["nodes"]:
        visit(root, np.eye(4))
    return Scene(
        np.concatenate(points),
        np.concatenate(normals),
        np.array(objects),
        np.array(materials),
        names,
        cameras,
        document,
        binary,
    )


def check_geometry(label, scene):
    """Finite, no degenerate or duplicate triangles, unit normals on the side of the winding, consistent winding."""
    p = scene.points
    expect(np.isfinite(p).all() and np.isfinite(scene.normals).all(), f"{label}: a coordinate is not finite")
    face = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    twice_area = np.linalg.norm(face, axis=1)
    longest = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1)
    height = twice_area / longest
    expect(height.min() > MIN_HEIGHT, f"{label}: {np.sum(height <= MIN_HEIGHT)} degenerate triangles")
    grid = np.round(p * 1e6).astype(np.int64)
    whole = [tuple(sorted(map(tuple, corners))) for corners in grid.tolist()]
    expect(len(set(whole)) == len(whole), f"{label}: {len(whole) - len(set(whole))} duplicate triangles")
    size = np.linalg.norm(scene.normals, axis=2)
    expect(np.abs(size - 1).max() < 1e-5, f"{label}: a normal is not of unit length")
    agreement = np.einsum("tci,ti->tc", scene.normals, face / twice_area[:, None]).min()
    expect(agreement > MIN_AGREEMENT, f"{label}: a normal contradicts its triangle's winding (cosine {agreement:.3f})")
    check_winding(label, scene, grid)
    return height.min(), agreement


def check_winding(label, scene, grid):
    """Two triangles that share an edge run through it in opposite directions."""
    edges = {}
    for owner, corners in zip(scene.objects.tolist(), grid.tolist()):
        for a, b in ((0, 1), (1, 2), (2, 0)):
            key = (owner, tuple(corners[a]), tuple(corners[b]))
            edges[key] = edges.get(key, 0) + 1
    wrong = sorted({scene.names[key[0]] for key, count in edges.items() if count > 1})
    expect(not wrong, f"{label}: triangles of {', '.join(wrong)} meet with opposite windings")


def check_closed(label, scene):
    grid = np.round(scene.points * 1e6).astype(np.int64).tolist()
    edges = {(tuple(c[a]), tuple(c[b])) for c in grid for a, b in ((0, 1), (1, 2), (2, 0))}
    expect(all((b, a) in edges for a, b in edges), f"{label}: the surface has a border")


def seen_objects(scene, camera, width=800, height=600):
    """Objects that own a pixel of an id buffer. Opaque surfaces hide; panes are seen and hide nothing.
    Edge functions of the triangle and the eye (Olano and Greer 1997), so nothing is clipped."""
    world, fov = scene.cameras[camera]
    to_camera = np.linalg.inv(world)
    corners = scene.points @ to_camera[:3, :3].T + to_camera[:3, 3]
    half = math.tan(fov / 2)
    xs = ((np.arange(width) + 0.5) * 2 / width - 1) * half * width / height
    ys = (1 - (np.arange(height) + 0.5) * 2 / height) * half
    clear = np.array(["KHR_materials_transmission" in m.get("extensions", {}) for m in scene.document["materials"]])
    depth = np.full((height, width), np.inf)
    ids = np.full((height, width), -1)
    panes = []
    for index in np.argsort(clear[scene.materials], kind="stable"):
        v = corners[index]
        if (v[:, 2] >= 0).all():
            continue
        x0, x1, y0, y1 = 0, width, 0, height
        if (v[:, 2] < -1e-3).all():
            sx, sy = v[:, 0] / -v[:, 2], v[:, 1] / -v[:, 2]
            x0, x1 = np.searchsorted(xs, sx.min()), np.searchsorted(xs, sx.max(), "right")
            y0, y1 = np.searchsorted(-ys, -sy.max()), np.searchsorted(-ys, -sy.min(), "right")
            if x0 >= x1 or y0 >= y1:
                continue
        edge = np.array([np.cross(v[1], v[2]), np.cross(v[2], v[0]), np.cross(v[0], v[1])])
        volume = v[0] @ edge[0]
        if volume == 0:
            continue
        x, y = xs[x0:x1][None, :], ys[y0:y1][:, None]
        weights = [(e[0] * x + e[1] * y - e[2]) / volume for e in edge]
        total = weights[0] + weights[1] + weights[2]  # 1 / distance along the ray of unit depth
        inside = (weights[0] >= 0) & (weights[1] >= 0) & (weights[2] >= 0) & (total > 0)
        distance = np.where(inside, 1 / np.where(inside, total, 1), np.inf)
        nearer = distance < depth[y0:y1, x0:x1]
        if clear[scene.materials[index]]:
            if nearer.any():
                panes.append(scene.objects[index])
            continue
        depth[y0:y1, x0:x1][nearer] = distance[nearer]
        ids[y0:y1, x0:x1][nearer] = scene.objects[index]
    expect((ids >= 0).all(), f"camera {camera} sees out of the closed room")
    return set(ids[ids >= 0].tolist()) | set(panes)


def check_kitchen():
    path = SCENES / "kitchen" / "kitchen.glb"
    scene = load(path)
    expect(len(scene.names) == OBJECTS, f"kitchen: {len(scene.names)} objects instead of {OBJECTS}")
    expect(len(scene.points) == TRIANGLES, f"kitchen: {len(scene.points)} triangles instead of {TRIANGLES}")
    expect(len(set(scene.names)) == len(scene.names), "kitchen: two objects have the same name")
    height, agreement = check_geometry("kitchen", scene)
    low, high = scene.points.min(axis=1), scene.points.max(axis=1)
    outside = {scene.names[o] for o in scene.objects[((low < ROOM_LOW) | (high > ROOM_HIGH)).any(axis=1)]}
    expect(not outside, f"kitchen: outside the room: {', '.join(sorted(outside))}")
    for material in scene.document["materials"]:
        color = material["pbrMetallicRoughness"]["baseColorFactor"][:3]
        textured_or_clear = "baseColorTexture" in material[
            "pbrMetallicRoughness"
        ] or "KHR_materials_transmission" in material.get("extensions", {})
        expect(textured_or_clear or max(color) <= 0.85, f"kitchen: {material['name']} is brighter than 0.85")
    emissive = [i for i, m in enumerate(scene.document["materials"]) if "emissiveFactor" in m]
    lights = int(np.isin(scene.materials, emissive).sum())
    expect(1 <= lights <= 16, f"kitchen: {lights} emissive triangles")
    images = sum(scene.document["bufferViews"][i["bufferView"]]["byteLength"] for i in scene.document["images"])
    expect(path.stat().st_size < 3_000_000 and images < 600_000, "kitchen: the file or its textures are too big")
    seen = seen_objects(scene, "Camera")
    expect(len(seen) >= SEEN, f"kitchen: only {len(seen)} objects are seen from Camera")
    print(
        f"kitchen: {len(scene.names)} objects, {len(scene.points)} triangles, {len(seen)} objects seen, "
        f"{lights} emissive triangles, {path.stat().st_size} bytes (textures {images}), "
        f"thinnest triangle {height * 1000:.2f} mm, normals agree to {agreement:.2f}"
    )
    print("  not seen: " + ", ".join(n for i, n in enumerate(scene.names) if i not in seen))


def check_small():
    for name, count in SMALL.items():
        scene = load(SCENES / name)
        expect(len(scene.points) == count, f"{name}: {len(scene.points)} triangles instead of {count}")
        check_geometry(name, scene)
        expect("Camera" in scene.cameras, f"{name}: there is no camera named Camera")
        print(f"{name}: {len(scene.names)} objects, {len(scene.points)} triangles")
    furnace = load(SCENES / "furnace" / "furnace.glb")
    check_closed("furnace", furnace)
    expect(np.abs(np.linalg.norm(furnace.points, axis=2) - 1).max() < 2e-6, "furnace: the radius is not 1")
    expect(
        (np.einsum("tci,tci->tc", furnace.points, furnace.normals) < -0.999).all(), "furnace: its front is not inside"
    )


def geometry_bytes(path):
    """What a file says besides its compressed images, whose bytes depend on the zlib at hand."""
    document, binary = read_file(path)
    views = document["bufferViews"]
    first_image = min((views[i["bufferView"]]["byteOffset"] for i in document.get("images", [])), default=len(binary))
    return [document[k] for k in ("nodes", "meshes", "cameras", "materials", "accessors")], binary[:first_image]


def check_generators():
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder)
        (target / "kitchen").mkdir()
        for command in (["make_kitchen.py", "-o", target / "kitchen" / "kitchen.glb"], ["make_small.py", "-o", target]):
            subprocess.run(
                [sys.executable, "-B", GENERATORS / command[0], *command[1:]], check=True, stdout=subprocess.DEVNULL
            )
        for name in ("kitchen/kitchen.glb", *SMALL):
            expect(
                geometry_bytes(target / name) == geometry_bytes(SCENES / name),
                f"{name}: its generator writes another file",
            )


def check_storeroom():
    """Made on demand: as large as asked, the same each time, closed to its camera, a smaller one's things in a larger one."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [pathlib.Path(folder) / name for name in ("small.glb", "again.glb", "large.glb")]
        for path, triangles in zip(paths, (30_000, 30_000, 60_000)):
            subprocess.run(
                [sys.executable, "-B", GENERATORS / "make_storeroom.py", "--triangles", str(triangles), "-o", path],
                check=True,
                stdout=subprocess.DEVNULL,
            )
        small, large = load(paths[0]), load(paths[2])
        expect(paths[0].read_bytes() == paths[1].read_bytes(), "storeroom: two runs write different files")
        for scene, triangles in ((small, 30_000), (large, 60_000)):
            count = len(scene.points)
            expect(abs(count / triangles - 1) < 0.02, f"storeroom: {count} triangles instead of {triangles}")
            emissive = [i for i, m in enumerate(scene.document["materials"]) if "emissiveFactor" in m]
            expect(np.isin(scene.materials, emissive).sum() == 6, "storeroom: its lamps are not six triangles")
        check_geometry("storeroom", small)
        seen_objects(small, "Camera")
        places = {node["name"]: node.get("translation") for node in large.document["nodes"]}
        moved = [n["name"] for n in small.document["nodes"] if places.get(n["name"], ()) != n.get("translation")]
        posts = {"Board", "Post", "Leg", "Table top", "Shade", "Cord", "Light"}  # many of one name
        expect(not set(moved) - posts, f"storeroom: in a larger one these lie elsewhere: {', '.join(moved)}")
        print(f"storeroom: {len(small.points)} and {len(large.points)} triangles")


def main():
    check_kitchen()
    check_small()
    check_storeroom()
    check_generators()
    for message in failures:
        print(f"FAILED: {message}")
    print("all scenes are sound" if not failures else f"{len(failures)} checks failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
