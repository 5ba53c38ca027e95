# SPDX-License-Identifier: Apache-2.0
"""Small scenes with known answers: Cornell box, furnace, parallel planes, wall, sphere."""

import math

from modelling.gltf import Scene
from modelling.material import Material, emitter, matte
from modelling.shapes import polygon
from modelling.surface import Model, Surface
from modelling.vectors import add, cross, dot, lerp, normalize, scale, sub

GREY = matte("Grey", (0.5, 0.5, 0.5))


def icosphere(radius, subdivisions, inward=False):
    """Smooth radial normals. An inward one shows its front to whoever is inside."""
    g = (1 + math.sqrt(5)) / 2
    corners = [
        normalize(v) for a, b in ((-1, g), (1, g), (-1, -g), (1, -g)) for v in ((a, b, 0.0), (0.0, a, b), (b, 0.0, a))
    ]
    near = [(i, j) for i in range(12) for j in range(i) if dot(corners[i], corners[j]) > 0.4]
    faces = [(i, j, k) for i, j in near for k in range(j) if (j, k) in near and (i, k) in near]
    triangles = [[corners[i] for i in face] for face in faces]
    for _ in range(subdivisions):
        finer = []
        for a, b, c in triangles:
            ab, bc, ca = (normalize(lerp(p, q, 0.5)) for p, q in ((a, b), (b, c), (c, a)))
            finer += [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        triangles = finer
    surface = Surface()
    sign = -1.0 if inward else 1.0
    for a, b, c in triangles:
        if dot(cross(sub(b, a), sub(c, a)), a) * sign < 0:
            b, c = c, b
        surface.triangle(*((scale(p, radius), scale(p, sign), (0.0, 0.0)) for p in (a, b, c)))
    return surface


def square(centre, u, v, half):
    """Facing u x v."""
    a, b = scale(u, half), scale(v, half)
    return polygon([add(centre, add(scale(a, s), scale(b, t))) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def box_without_bottom(top):
    """`top` runs counter-clockwise seen from above."""
    surface = polygon(top)
    for p, q in zip(top, top[1:] + top[:1]):
        surface.extend(polygon([q, p, (p[0], 0.0, p[2]), (q[0], 0.0, q[2])]))
    return surface


def cornell():
    """The box of Goral et al. 1984 with the measured geometry, millimetres read as centimetres; its spectra as
    linear RGB."""
    white = matte("White", (0.740, 0.742, 0.734))
    red, green = matte("Red", (0.611, 0.056, 0.062)), matte("Green", (0.117, 0.413, 0.115))
    w, h, d = 5.56, 5.488, 5.592
    scene = Scene("Cornell box")
    scene.add("Floor", Model((white, polygon([(0, 0, 0), (0, 0, d), (w, 0, d), (w, 0, 0)]))))
    scene.add("Ceiling", Model((white, polygon([(0, h, 0), (w, h, 0), (w, h, d), (0, h, d)]))))
    scene.add("Back wall", Model((white, polygon([(w, 0, d), (0, 0, d), (0, h, d), (w, h, d)]))))
    scene.add("Right wall", Model((green, polygon([(0, 0, d), (0, 0, 0), (0, h, 0), (0, h, d)]))))
    scene.add("Left wall", Model((red, polygon([(w, 0, 0), (w, 0, d), (w, h, d), (w, h, 0)]))))
    short = [(1.30, 1.65, 0.65), (0.82, 1.65, 2.25), (2.40, 1.65, 2.72), (2.90, 1.65, 1.14)]
    tall = [(4.23, 3.30, 2.47), (2.65, 3.30, 2.96), (3.14, 3.30, 4.56), (4.72, 3.30, 4.06)]
    scene.add("Short block", Model((white, box_without_bottom(short))))
    scene.add("Tall block", Model((white, box_without_bottom(tall))))
    light = polygon(
        [(2.13, h - 0.001, 2.27), (3.43, h - 0.001, 2.27), (3.43, h - 0.001, 3.32), (2.13, h - 0.001, 3.32)]
    )
    scene.add("Light", Model((emitter("Light", (18.4, 15.6, 8.0)), light)))
    scene.camera("Camera", (2.78, 2.73, -8.0), (2.78, 2.73, 0.0), 39.3, aspect=1.0)
    return scene


def furnace():
    wall = Material("Furnace", (0.5, 0.5, 0.5), emission=(1.0, 1.0, 1.0))
    scene = Scene("Furnace")
    scene.add("Sphere", Model((wall, icosphere(1.0, 4, inward=True))))
    scene.camera("Camera", (0.0, 0.0, 0.0), (0.0, 0.0, -1.0), 60.0)
    return scene


def planes():
    scene = Scene("Parallel planes")
    scene.add("Floor", Model((GREY, square((0, 0, 0), Z, X, 20.0))))
    scene.add("Ceiling", Model((GREY, square((0, 0.25, 0), X, Z, 20.0))))
    scene.camera("Camera", (0.0, 0.125, 0.5), (0.0, 0.06, 0.0), 50.0)
    return scene


def wall():
    scene = Scene("Wall")
    scene.add("Floor", Model((GREY, square((20.0, 0, 0), Z, X, 20.0))))
    scene.add("Wall", Model((GREY, square((0, 20.0, 0), Y, Z, 20.0))))
    scene.camera("Camera", (2.4, 1.2, 0.0), (0.0, 0.4, 0.0), 50.0)
    return scene


def sphere():
    scene = Scene("Sphere")
    scene.add("Floor", Model((GREY, square((0, 0, 0), Z, X, 5.0))))
    scene.add("Sphere", Model((matte("Red", (0.65, 0.10, 0.08)), icosphere(0.5, 4))), at=(0.0, 0.5, 0.0))
    scene.add("Light", Model((emitter("Light", (10.0, 10.0, 10.0)), square((1.0, 3.0, 1.0), X, Z, 0.5))))
    scene.camera("Camera", (0.0, 1.1, 2.6), (0.0, 0.40, 0.0), 40.0)
    return scene


FILES = {
    "cornell/cornell.gltf": cornell,
    "furnace/furnace.glb": furnace,
    "planes/planes.gltf": planes,
    "wall/wall.gltf": wall,
    "sphere/sphere.glb": sphere,
}
