# SPDX-License-Identifier: Apache-2.0
"""Surface: a triangle soup with normals and texture coordinates; Model: surfaces with their materials."""

from .vectors import NO_ROTATION, add, cross, length, rotate, rotation, sub

GRID = 1e-6  # positions are kept on a micrometre grid: equal points are equal bits
MIN_HEIGHT = 2e-5  # thinner triangles are slivers that appear where loops meet: left out


def snap(point):
    return tuple(round(c / GRID) * GRID + 0.0 for c in point)


class Surface:
    """Corners are (position, normal, uv); each triangle has three. uv is in metres on the surface."""

    def __init__(self):
        self.triangles = []

    def triangle(self, a, b, c):
        a, b, c = ((snap(p), n, t) for p, n, t in (a, b, c))
        edges = [sub(b[0], a[0]), sub(c[0], b[0]), sub(a[0], c[0])]
        twice_area = length(cross(edges[0], edges[1]))
        if twice_area > MIN_HEIGHT * max(length(e) for e in edges):
            self.triangles.append((a, b, c))

    def quad(self, a, b, c, d):
        self.triangle(a, b, c)
        self.triangle(a, c, d)

    def extend(self, other):
        self.triangles.extend(other.triangles)
        return self

    def _mapped(self, position, normal, flip=False):
        result = Surface()
        for corners in self.triangles:
            moved = [(snap(position(p)), normal(n), t) for p, n, t in corners]
            result.triangles.append(tuple(reversed(moved)) if flip else tuple(moved))
        return result

    def moved(self, x, y, z):
        return self._mapped(lambda p: add(p, (x, y, z)), lambda n: n)

    def turned(self, *turns):
        q = rotation(*turns)
        return self._mapped(lambda p: rotate(q, p), lambda n: rotate(q, n))

    def mirrored(self, axis):
        """Mirrored in the plane through the origin across "x", "y" or "z"."""
        s = tuple(-1.0 if a == axis else 1.0 for a in "xyz")
        flip = lambda v: (v[0] * s[0], v[1] * s[1], v[2] * s[2])
        return self._mapped(flip, flip, flip=True)

    def flipped(self):
        """Inside out."""
        return self._mapped(lambda p: p, lambda n: (-n[0], -n[1], -n[2]), flip=True)


class Model:
    """What one mesh is made of: a surface per material, in the order of first use."""

    def __init__(self, *parts):
        self.parts = {}
        for material, surface in parts:
            self.add(material, surface)

    @classmethod
    def of_mesh(cls, material, mesh):
        """Of one ArrayMesh, as it is."""
        model = cls()
        model.parts[material] = mesh
        return model

    def add(self, material, *surfaces):
        for surface in surfaces:
            self.parts.setdefault(material, Surface()).extend(surface)
        return self

    def triangle_count(self):
        return sum(len(surface.triangles) for surface in self.parts.values())


__all__ = ["GRID", "Model", "NO_ROTATION", "Surface", "snap"]
