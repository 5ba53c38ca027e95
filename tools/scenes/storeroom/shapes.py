# SPDX-License-Identifier: Apache-2.0
"""Shapes that can be tessellated as finely as wanted. Each is made of `cells` * level**2 triangles."""

import functools
import math

import numpy as np

from modelling.arrays import creased, snapped, vertex_normals

MIN_LEVEL = 2


class Shape:
    def __init__(self, cells, build):
        self.cells, self.build = cells, build  # build(level): (positions, triangles)
        self._relief = None

    def displaced(self, seed, height, wavelength):
        """Raised along its normals by smooth noise of about `height`, both in metres."""
        self._relief = (seed, height, wavelength)
        return self

    def level(self, triangles):
        return max(MIN_LEVEL, round(math.sqrt(triangles / self.cells)))

    def count(self, level):
        return self.cells * level**2

    def mesh(self, level):
        positions, triangles = self.build(level)
        if self._relief:
            seed, height, wavelength = self._relief
            rise = height * noise(positions, seed, wavelength)
            positions = positions + rise[:, None] * vertex_normals(positions, triangles)
        return creased(snapped(positions), triangles)


def noise(points, seed, wavelength, octaves=6):
    """About -1 to 1: octaves of sines along random directions, each twice as fine and half as high as the last."""
    random = np.random.default_rng(seed)
    result = np.zeros(len(points))
    for octave in range(octaves):
        waves = random.normal(size=(4, 3)) * (2 * math.pi / wavelength * 2**octave / math.sqrt(3))
        phases = random.uniform(0, 2 * math.pi, 4)
        for wave, phase in zip(waves, phases):
            result += np.sin(points[:, 0] * wave[0] + points[:, 1] * wave[1] + points[:, 2] * wave[2] + phase) / 2**octave
    return result / 4


def grid_triangles(columns, rows, around=False, along=False):
    """Two triangles for each cell of a grid of vertices, row after row; it may close around its columns and rows."""
    width, height = columns + (not around), rows + (not along)
    i, j = np.meshgrid(np.arange(columns), np.arange(rows))
    right, above = (i + 1) % width, (j + 1) % height
    a, b, c, d = j * width + i, j * width + right, above * width + right, above * width + i
    return np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], -2).reshape(-1, 3)


@functools.lru_cache(maxsize=64)
def _cube(level):
    """The surface of the cube [-1, 1]^3, its edges cut into `level` parts, without double vertices."""
    i, j = np.meshgrid(np.arange(level + 1), np.arange(level + 1))
    i, j = i.ravel(), j.ravel()
    corners, triangles = [], []
    for axis in range(3):
        for side in (0, level):
            face = np.empty((len(i), 3), dtype=np.int64)
            face[:, axis], face[:, (axis + 1) % 3], face[:, (axis + 2) % 3] = side, i, j
            cells = grid_triangles(level, level) + len(corners) * len(i)
            triangles.append(cells if side else cells[:, ::-1])
            corners.append(face)
    corners = np.concatenate(corners)
    key = (corners[:, 0] * (level + 1) + corners[:, 1]) * (level + 1) + corners[:, 2]
    _, first, index = np.unique(key, return_index=True, return_inverse=True)
    return corners[first] * (2 / level) - 1, index[np.concatenate(triangles)]


def ball(size, exponent=2.0):
    """A superellipsoid of the half-axes `size`: 2 is an ellipsoid, larger exponents are boxes with rounder edges."""

    def build(level):
        cube, triangles = _cube(level)
        if exponent < 4:  # more even cells on the sphere
            cube = np.tan(cube * (math.pi / 4))
        radius = (np.abs(cube) ** exponent).sum(axis=1) ** (1 / exponent)
        return cube / radius[:, None] * np.asarray(size), triangles

    return Shape(12, build)


def sheet(f, aspect):
    """The surface f(s, t), s and t from 0 to 1, facing df/ds x df/dt; `aspect` times as many columns as rows."""

    def build(level):
        columns = aspect * level
        s, t = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, level + 1))
        return np.stack(f(s.ravel(), t.ravel()), -1), grid_triangles(columns, level)

    return Shape(2 * aspect, build)


def rectangle(origin, u, v, aspect=1):
    origin, u, v = (np.asarray(x, dtype=float) for x in (origin, u, v))
    return sheet(lambda s, t: tuple(origin[k] + s * u[k] + t * v[k] for k in range(3)), aspect)


def ring(path, radius, aspect):
    """A tube of `radius` along the closed curve path(angle), which is nowhere vertical; `aspect` rings for two sides."""

    def build(level):
        columns, rows = 2 * level, aspect * level
        angle = np.arange(rows) * (2 * math.pi / rows)
        points = np.stack(path(angle), -1)
        tangent = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        u = np.cross(tangent, (0.0, 1.0, 0.0))
        u /= np.linalg.norm(u, axis=1)[:, None]
        v = np.cross(u, tangent)
        around = np.arange(columns) * (2 * math.pi / columns)
        section = np.cos(around)[None, :, None] * u[:, None] + np.sin(around)[None, :, None] * v[:, None]
        return (points[:, None] + radius * section).reshape(-1, 3), grid_triangles(columns, rows, True, True)[:, ::-1]

    return Shape(4 * aspect, build)


def lathe(profile, aspect=2):
    """The rounded polyline `profile` of (radius, height), no radius 0, turned about the y axis: outside upwards."""
    points = np.asarray(profile, dtype=float)
    for _ in range(3):  # Chaikin's corner cutting
        cut = np.stack([points[:-1] * 0.75 + points[1:] * 0.25, points[:-1] * 0.25 + points[1:] * 0.75], 1)
        points = np.concatenate([points[:1], cut.reshape(-1, 2), points[-1:]])
    travelled = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])

    def build(level):
        columns, rows = aspect * level, level
        along = np.linspace(0, travelled[-1], rows + 1)
        radius, height = np.interp(along, travelled, points[:, 0]), np.interp(along, travelled, points[:, 1])
        around = np.arange(columns) * (2 * math.pi / columns)
        positions = np.stack([radius[:, None] * np.sin(around), np.broadcast_to(height[:, None], (rows + 1, columns)),
                              radius[:, None] * np.cos(around)], -1)
        return positions.reshape(-1, 3), grid_triangles(columns, rows, around=True)

    return Shape(2 * aspect, build)


def tuft(seed, radius, height, aspect=12):
    """Blades of grass: long thin triangles without order."""

    def build(level):
        random = np.random.default_rng(seed)
        blades = aspect * level
        angle, lean = random.uniform(0, 2 * math.pi, (2, blades))
        distance = radius * 0.5 * np.sqrt(random.uniform(0, 1, blades))
        bend = random.uniform(0.3, 1.0, blades) * radius
        length = height * random.uniform(0.6, 1.0, blades)
        width = 0.02 * height * random.uniform(0.5, 1.0, blades)
        t = np.linspace(0, 1, level + 1)[None, :, None]
        side = np.array([-1.0, 1.0])[None, None, :]
        shape = lambda x: x[:, None, None]
        taper = shape(width) * side * (1 - 0.9 * t)
        x = shape(distance * np.cos(angle)) + shape(bend * np.cos(lean)) * t**2 + shape(np.sin(lean)) * taper
        z = shape(distance * np.sin(angle)) + shape(bend * np.sin(lean)) * t**2 - shape(np.cos(lean)) * taper
        y = shape(length) * t * (1 - 0.3 * t) + 0 * side
        one = grid_triangles(1, level)
        positions = np.stack(np.broadcast_arrays(x, y, z), -1).reshape(-1, 3)
        return positions, (np.arange(blades)[:, None, None] * (2 * level + 2) + one).reshape(-1, 3)

    return Shape(2 * aspect, build)
