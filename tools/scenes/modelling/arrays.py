# SPDX-License-Identifier: Apache-2.0
"""ArrayMesh: a surface in numpy's arrays, for meshes too large for Surface."""

from dataclasses import dataclass

import numpy as np

from .gltf import FLOAT, UINT
from .surface import GRID

CREASE = 0.5  # cosine between a corner's normal and its triangle's, below which the corner is shaded flat


@dataclass
class ArrayMesh:
    positions: np.ndarray  # vertex, xyz
    normals: np.ndarray
    triangles: np.ndarray  # triangle, its three vertices

    def arrays(self, document):
        """The glTF primitive; document takes the bytes."""
        positions, normals = self.positions.astype("<f4"), self.normals.astype("<f4")
        extent = [positions.min(axis=0).tolist(), positions.max(axis=0).tolist()]
        indices = self.triangles.astype("<u4").tobytes()
        count = len(positions)
        return {
            "attributes": {
                "POSITION": document.append("POSITION", positions.tobytes(), FLOAT, count, 3, extent),
                "NORMAL": document.append("NORMAL", normals.tobytes(), FLOAT, count, 3),
            },
            "indices": document.append("indices", indices, UINT, self.triangles.size, 1),
        }


def snapped(positions):
    return np.round(positions / GRID) * GRID


def creased(positions, triangles):
    """The mesh with smooth normals, but for the corners at sharp edges."""
    normals = vertex_normals(positions, triangles)
    facing = _unit(_facing(positions, triangles))
    sharp = np.einsum("tci,ti->tc", normals[triangles], facing) < CREASE
    triangle, _ = np.nonzero(sharp)
    corners = triangles[sharp]
    triangles = triangles.copy()
    triangles[sharp] = len(positions) + np.arange(len(corners))
    return ArrayMesh(
        np.concatenate([positions, positions[corners]]), np.concatenate([normals, facing[triangle]]), triangles
    )


def vertex_normals(positions, triangles):
    """Unit normals, each the mean of the triangles around, weighted by their areas."""
    facing, corners = _facing(positions, triangles), triangles.ravel()
    return _unit(
        np.stack([np.bincount(corners, np.repeat(facing[:, k], 3), len(positions)) for k in range(3)], -1)
    )


def _facing(positions, triangles):
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def _unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-30)[:, None]
