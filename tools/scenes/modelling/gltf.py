# SPDX-License-Identifier: Apache-2.0
"""Scene: a tree of nodes with models and cameras, written as .glb or as .gltf with an embedded buffer."""

import base64
import json
import math
import struct
from contextlib import contextmanager

from .vectors import NO_ROTATION, look_rotation, rotation

FLOAT, USHORT, UINT = 5126, 5123, 5125
ARRAY, ELEMENTS = 34962, 34963


class Scene:
    def __init__(self, name):
        self.name = name
        self.nodes = []
        self.roots = []
        self._children = self.roots
        self._models = {}  # by id, in order of first use; instances share one

    def add(self, name, model, at=(0.0, 0.0, 0.0), turn=()):
        """`turn`: turns like [("y", 30)], done before the move to `at`."""
        index, _ = self._models.setdefault(id(model), (len(self._models), model))
        self._node(name, at, rotation(*turn), {"mesh": index})

    def models(self):
        return [model for _, model in self._models.values()]

    @contextmanager
    def group(self, name, at=(0.0, 0.0, 0.0), turn=()):
        children = []
        self._node(name, at, rotation(*turn), {"children": children})
        outer, self._children = self._children, children
        yield
        self._children = outer

    def camera(self, name, eye, target, vertical_fov, aspect=4 / 3):
        camera = {
            "type": "perspective",
            "name": name,
            "perspective": {"aspectRatio": aspect, "yfov": math.radians(vertical_fov), "znear": 0.01},
        }
        self._node(name, eye, look_rotation(eye, target), {"camera": camera})

    def _node(self, name, at, turn, content):
        node = {"name": name, **content}
        if any(at):
            node["translation"] = [round(c, 6) for c in at]
        if turn != NO_ROTATION:
            node["rotation"] = [round(c, 8) + 0.0 for c in turn]
        self._children.append(len(self.nodes))
        self.nodes.append(node)

    def counts(self):
        """(nodes with a mesh, triangles)"""
        triangles = self.triangles_by_name()
        return len(triangles), sum(count for _, count in triangles)

    def triangles_by_name(self):
        counts = [model.triangle_count() for model in self.models()]
        return [(node["name"], counts[node["mesh"]]) for node in self.nodes if "mesh" in node]

    def write(self, path):
        document, binary = _Document(self).finish()
        if str(path).endswith(".glb"):
            data = _pack_glb(document, binary)
        else:
            uri = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
            document["buffers"][0]["uri"] = uri
            data = (json.dumps(document, indent=1) + "\n").encode()
        with open(path, "wb") as file:
            file.write(data)
        return len(data)


def _pack_glb(document, binary):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    return (
        struct.pack("<4sII", b"glTF", 2, total)
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(binary), b"BIN\0")
        + binary
    )


class _Document:
    """The JSON under construction. One buffer view each for positions, normals, texture coordinates and
    indices, then one per image."""

    def __init__(self, scene):
        self.scene = scene
        self.materials, self.textures, self.accessors = [], [], []
        self.streams = {
            "POSITION": bytearray(),
            "NORMAL": bytearray(),
            "TEXCOORD_0": bytearray(),
            "indices": bytearray(),
        }
        self.extensions = set()

    def finish(self):
        # Named after the first node that uses it.
        names = {node["mesh"]: node["name"] for node in reversed(self.scene.nodes) if "mesh" in node}
        meshes = [self._mesh(names[i], model) for i, model in enumerate(self.scene.models())]
        materials = [self._material(m) for m in self.materials]
        nodes, cameras = [], []
        for node in self.scene.nodes:
            node = dict(node)
            if "camera" in node:
                cameras.append(node["camera"])
                node["camera"] = len(cameras) - 1
            nodes.append(node)
        binary, views = bytearray(), []
        strides = {"POSITION": 12, "NORMAL": 12, "TEXCOORD_0": 8}
        view_index = {}
        for name, data in self.streams.items():
            if data:
                view_index[name] = len(views)
                view = {"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)}
                view |= {"byteStride": strides[name], "target": ARRAY} if name in strides else {"target": ELEMENTS}
                views.append(view)
                binary += data
                binary += bytes(-len(binary) % 4)
        for accessor in self.accessors:
            accessor["bufferView"] = view_index[accessor["bufferView"]]
        images = []
        for texture in self.textures:
            images.append({"name": texture.name, "mimeType": "image/png", "bufferView": len(views)})
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(texture.png)})
            binary += texture.png + bytes(-len(texture.png) % 4)
        document = {
            "asset": {"version": "2.0", "generator": "obscura tools/scenes", "copyright": "Apache-2.0"},
            "extensionsUsed": sorted(self.extensions),
            "scene": 0,
            "scenes": [{"name": self.scene.name, "nodes": self.scene.roots}],
            "nodes": nodes,
            "meshes": meshes,
            "cameras": cameras,
            "materials": materials,
            "textures": [{"source": i, "sampler": 0} for i in range(len(images))],
            "samplers": [{"magFilter": 9729, "minFilter": 9729, "wrapS": 10497, "wrapT": 10497}] if images else [],
            "images": images,
            "accessors": self.accessors,
            "bufferViews": views,
            "buffers": [{"byteLength": len(binary)}],
        }
        return {k: v for k, v in document.items() if v != []}, bytes(binary)

    def _mesh(self, name, model):
        return {"name": name, "primitives": [self._primitive(m, s) for m, s in model.parts.items()]}

    def _primitive(self, material, surface):
        if material not in self.materials:
            self.materials.append(material)
        primitive = surface.arrays(self) if hasattr(surface, "arrays") else self._corners(surface, material.texture)
        return primitive | {"material": self.materials.index(material)}

    def _corners(self, surface, texture):
        vertices, indices = {}, []
        for corners in surface.triangles:
            for p, n, t in corners:
                size = math.sqrt(n[0] ** 2 + n[1] ** 2 + n[2] ** 2)
                normal = tuple(round(c / size, 7) + 0.0 for c in n)
                uv = (round(t[0] / texture.size[0], 6), round(t[1] / texture.size[1], 6)) if texture else ()
                indices.append(vertices.setdefault((p, normal, uv), len(vertices)))
        positions = [v[0] for v in vertices]
        primitive = {
            "attributes": {
                "POSITION": self._accessor("POSITION", [c for p in positions for c in p], 3, bounds=positions),
                "NORMAL": self._accessor("NORMAL", [c for v in vertices for c in v[1]], 3),
            }
        }
        if texture:
            primitive["attributes"]["TEXCOORD_0"] = self._accessor("TEXCOORD_0", [c for v in vertices for c in v[2]], 2)
        primitive["indices"] = self._accessor("indices", indices, 1)
        return primitive

    def _accessor(self, stream, values, width, bounds=None):
        integer = stream == "indices"
        if integer:
            assert max(values) < 65535
        extent = None
        if bounds:
            single = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in bounds]
            extent = [[pick(p[i] for p in single) for i in range(3)] for pick in (min, max)]
        data = struct.pack(f"<{len(values)}{'H' if integer else 'f'}", *values)
        return self.append(stream, data, USHORT if integer else FLOAT, len(values) // width, width, extent)

    def append(self, stream, data, component, count, width, extent=None):
        """An accessor over bytes that are added to a stream; extent: least and greatest values."""
        accessor = {
            "bufferView": stream,
            "byteOffset": len(self.streams[stream]),
            "componentType": component,
            "count": count,
            "type": {1: "SCALAR", 2: "VEC2", 3: "VEC3"}[width],
        }
        if extent:
            accessor["min"], accessor["max"] = extent
        self.streams[stream] += data
        self.streams[stream] += bytes(-len(data) % 4)
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def _material(self, m):
        pbr = {"baseColorFactor": [*m.color, 1.0], "metallicFactor": m.metallic, "roughnessFactor": m.roughness}
        if m.texture:
            if m.texture not in self.textures:
                self.textures.append(m.texture)
            pbr["baseColorTexture"] = {"index": self.textures.index(m.texture)}
        result = {"name": m.name, "pbrMetallicRoughness": pbr}
        extensions = {}
        if m.specular != 1.0 and m.metallic == 0.0:
            extensions["KHR_materials_specular"] = {"specularFactor": m.specular}
        if m.transmission > 0:
            extensions["KHR_materials_transmission"] = {"transmissionFactor": m.transmission}
        if any(m.emission):
            strength = max(m.emission)
            result["emissiveFactor"] = [round(c / strength, 6) for c in m.emission]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if extensions:
            result["extensions"] = extensions
            self.extensions |= set(extensions)
        if m.double_sided:
            result["doubleSided"] = True
        return result
