# SPDX-License-Identifier: Apache-2.0
"""The reader of tools/check_radiometry.py: glTF files and PNG images as numpy arrays. It shares nothing with
the program's own reader."""
import base64
import json
import math
import struct
import urllib.parse
import zlib

import numpy as np

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
TYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
LARGEST = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}


class Unreadable(Exception):
    """The scene uses something that this script does not read."""


def float32(value):
    """What a value becomes in the program, in double."""
    return np.asarray(value, dtype=np.float32).astype(np.float64)


class Gltf:
    def __init__(self, path):
        self.folder = path.parent
        data = path.read_bytes()
        self.binary = b""
        if data[:4] == b"glTF":
            offset = 12
            while offset < len(data):
                length, kind = struct.unpack_from("<I4s", data, offset)
                chunk = data[offset + 8 : offset + 8 + length]
                if kind == b"JSON":
                    text = chunk
                elif kind == b"BIN\0":
                    self.binary = chunk
                offset += 8 + length
            self.json = json.loads(text)
        else:
            self.json = json.loads(data)
        self.buffers = [self.resource(b.get("uri")) for b in self.json.get("buffers", [])]

    def resource(self, uri):
        if uri is None:
            return self.binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (self.folder / urllib.parse.unquote(uri)).read_bytes()

    def view(self, index):
        view = self.json["bufferViews"][index]
        start = view.get("byteOffset", 0)
        return self.buffers[view["buffer"]][start : start + view["byteLength"]], view.get("byteStride", 0)

    def elements(self, view, offset, count, component_type, components):
        data, stride = self.view(view)
        dtype = np.dtype(TYPES[component_type])
        stride = stride or dtype.itemsize * components
        return np.ndarray((count, components), dtype, data, offset, (stride, dtype.itemsize))

    def accessor(self, index):
        """count x components, in double; normalised integers as real numbers."""
        a = self.json["accessors"][index]
        kind, components = a["componentType"], COMPONENTS[a["type"]]
        values = self.elements(a["bufferView"], a.get("byteOffset", 0), a["count"], kind, components)
        values = values.astype(np.float64)
        if "sparse" in a:
            s = a["sparse"]
            i, v = s["indices"], s["values"]
            which = self.elements(i["bufferView"], i.get("byteOffset", 0), s["count"], i["componentType"], 1)
            values[which[:, 0].astype(np.int64)] = self.elements(
                v["bufferView"], v.get("byteOffset", 0), s["count"], kind, components)
        if a.get("normalized"):
            values = np.maximum(values / LARGEST[kind], -1)
        return values

    def image(self, texture):
        image = self.json["images"][self.json["textures"][texture]["source"]]
        data = self.view(image["bufferView"])[0] if "bufferView" in image else self.resource(image["uri"])
        return decode_png(data)


def decode_png(data):
    """height x width x 3 of 8-bit codes."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise Unreadable("an image that is not a PNG")
    offset, packed, palette = 8, b"", None
    while offset < len(data):
        length, kind = struct.unpack_from(">I4s", data, offset)
        chunk = data[offset + 8 : offset + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", chunk)
        elif kind == b"PLTE":
            palette = np.frombuffer(chunk, np.uint8).reshape(-1, 3)
        elif kind == b"IDAT":
            packed += chunk
        offset += 12 + length
    if interlaced:
        raise Unreadable("an interlaced PNG")
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[color]
    row_bytes = (width * channels * depth + 7) // 8
    step = max(1, channels * depth // 8)
    raw = zlib.decompress(packed)
    rows = np.zeros((height, row_bytes), np.uint8)
    previous = bytearray(row_bytes)
    for y in range(height):
        start = y * (row_bytes + 1)
        kind, row = raw[start], bytearray(raw[start + 1 : start + 1 + row_bytes])
        unfilter(kind, row, previous, step)
        rows[y] = np.frombuffer(bytes(row), np.uint8)
        previous = row
    if depth == 16:
        codes = rows.reshape(height, width, channels, 2).astype(np.uint32)
        pixels = np.round((codes[..., 0] * 256 + codes[..., 1]) / 257).astype(np.uint8)
    elif depth == 8:
        pixels = rows.reshape(height, width, channels)
    else:
        bits = np.unpackbits(rows, axis=1).reshape(height, -1, depth)
        codes = (bits * (1 << np.arange(depth - 1, -1, -1))).sum(axis=2)[:, :width, None]
        pixels = (codes if color == 3 else codes * 255 // ((1 << depth) - 1)).astype(np.uint8)
    if color == 3:
        return palette[pixels[..., 0]]
    return np.repeat(pixels[..., :1], 3, axis=2) if channels < 3 else pixels[..., :3]


def unfilter(kind, row, previous, step):
    """Undoes PNG's row filters 0 to 4 in place."""
    if kind == 2:
        above = np.frombuffer(bytes(previous), np.uint8)
        row[:] = (np.frombuffer(bytes(row), np.uint8) + above).tobytes()  # modulo 256
        return
    for i in range(len(row) if kind else 0):
        left = row[i - step] if i >= step else 0
        up = previous[i]
        corner = previous[i - step] if i >= step else 0
        if kind == 1:
            guess = left
        elif kind == 3:
            guess = (left + up) // 2
        else:
            p = left + up - corner
            guess = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
        row[i] = (row[i] + guess) & 255


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    quaternion = np.array(node.get("rotation", [0, 0, 0, 1]), float)
    x, y, z, w = quaternion / np.linalg.norm(quaternion)
    m = np.eye(4)
    m[:3, :3] = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]) * np.array(node.get("scale", [1, 1, 1]), float)
    m[:3, 3] = node.get("translation", [0, 0, 0])
    return m


def walk(gltf):
    """All nodes of the scene with their world matrices."""
    nodes = gltf.json.get("nodes", [])
    scenes = gltf.json.get("scenes", [])
    if scenes:
        roots = scenes[gltf.json.get("scene", 0)].get("nodes", [])
    else:
        children = {c for n in nodes for c in n.get("children", [])}
        roots = [i for i in range(len(nodes)) if i not in children]
    pending = [(i, np.eye(4)) for i in roots]
    while pending:
        index, parent = pending.pop()
        world = parent @ local_matrix(nodes[index])
        yield nodes[index], world
        pending += [(c, world) for c in nodes[index].get("children", [])]


def corner_indices(primitive, gltf, count):
    """n x 3 vertex indices of the primitive's triangles, winding left as it is."""
    mode = primitive.get("mode", 4)
    if "indices" in primitive:
        indices = gltf.accessor(primitive["indices"])[:, 0].astype(np.int64)
    else:
        indices = np.arange(count)
    if mode == 4:
        return indices.reshape(-1, 3)
    if mode == 5:
        return np.stack([indices[:-2], indices[1:-1], indices[2:]], axis=1)
    if mode == 6:
        return np.stack([np.full(len(indices) - 2, indices[0]), indices[1:-1], indices[2:]], axis=1)
    return np.zeros((0, 3), np.int64)


def uv_mapping(info):
    """Texture set, 2 x 2 matrix and offset of a texture reference (KHR_texture_transform)."""
    t = info.get("extensions", {}).get("KHR_texture_transform", {})
    angle = t.get("rotation", 0)
    rotation = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    return (t.get("texCoord", info.get("texCoord", 0)), rotation * np.array(t.get("scale", [1, 1]), float),
            np.array(t.get("offset", [0, 0]), float))
