# SPDX-License-Identifier: Apache-2.0
"""What lies about: each thing(radius, seed) gives its parts, standing on the origin, as (name, material, shape)."""

import numpy as np

from modelling.material import emitter, glossy, matte, metal

from .shapes import ball, lathe, rectangle, ring, tuft

STONES = [matte("Granite", (0.42, 0.40, 0.38)), matte("Sandstone", (0.62, 0.50, 0.34)), matte("Slate", (0.20, 0.22, 0.25))]
CLOTHS = [matte("Jute", (0.55, 0.44, 0.28)), matte("Red cloth", (0.55, 0.08, 0.07)), matte("Blue cloth", (0.10, 0.18, 0.45))]
GLAZES = [
    glossy("Green glaze", (0.10, 0.38, 0.20), 0.2),
    glossy("White glaze", (0.78, 0.76, 0.70), 0.15),
    glossy("Ochre glaze", (0.65, 0.40, 0.08), 0.25),
]
CLAYS = [matte("Terracotta", (0.58, 0.26, 0.15)), matte("Pale clay", (0.70, 0.62, 0.52))]
METALS = [metal("Brass", (0.80, 0.62, 0.25), 0.25), metal("Steel", (0.62, 0.62, 0.62), 0.15)]
WOOD = matte("Wood", (0.45, 0.29, 0.16))
DARK_WOOD = matte("Dark wood", (0.22, 0.13, 0.08))
LEAF = matte("Leaf", (0.12, 0.36, 0.08), double_sided=True)
LIGHT = emitter("Lamp", (160.0, 140.0, 110.0))


def stone(r, seed):
    return [("Stone", STONES[seed % 3], ball((r, 0.7 * r, 0.85 * r)).displaced(seed, 0.25 * r, 2 * r))], 0.6 * r


def sack(r, seed):
    return [("Sack", CLOTHS[seed % 3], ball((r, 0.6 * r, 0.75 * r), 3.0).displaced(seed, 0.12 * r, 1.2 * r))], 0.55 * r


def crate(r, seed):
    return [("Crate", WOOD, ball((0.7 * r, 0.5 * r, 0.6 * r), 14.0).displaced(seed, 0.02 * r, 0.3 * r))], 0.5 * r


def book(r, seed):
    return [("Book", CLOTHS[seed % 3], ball((0.7 * r, 0.15 * r, 0.5 * r), 20.0).displaced(seed, 0.01 * r, 0.2 * r))], 0.15 * r


def jar(r, seed):
    wall = 0.05 * r
    profile = [(0.02 * r, 0.0), (0.5 * r, 0.0), (0.85 * r, 0.6 * r), (0.5 * r, 1.5 * r), (0.55 * r, 1.8 * r)]
    inside = [(x - wall, y) for x, y in reversed(profile[2:])] + [(0.5 * r, wall), (0.02 * r, wall)]
    shape = lathe(profile + inside).displaced(seed, 0.012 * r, 0.4 * r)
    return [("Jar", (GLAZES + CLAYS)[seed % 5], shape)], 0.0


def bowl(r, seed):
    wall = 0.05 * r
    profile = [(0.02 * r, 0.0), (0.4 * r, 0.0), (0.8 * r, 0.25 * r), (r, 0.6 * r)]
    inside = [(r - wall, 0.6 * r), (0.75 * r, 0.3 * r), (0.35 * r, wall), (0.02 * r, wall)]
    return [("Bowl", (GLAZES + METALS)[seed % 5], lathe(profile + inside).displaced(seed, 0.008 * r, 0.3 * r))], 0.0


def hoop(r, seed):
    thick = 0.16 * r
    path = lambda a: ((r - thick) * np.cos(a), 0 * a, (r - thick) * np.sin(a))
    return [("Hoop", METALS[seed % 2], ring(path, thick, 5).displaced(seed, 0.1 * thick, thick))], thick


def knot(r, seed):
    def path(a):
        return (r * 0.36 * (np.sin(a) + 2 * np.sin(2 * a)), r * 0.5 * np.sin(3 * a), r * 0.36 * (np.cos(a) - 2 * np.cos(2 * a)))

    return [("Knot", (STONES + METALS)[seed % 5], ring(path, 0.17 * r, 12).displaced(seed, 0.05 * r, 0.6 * r))], 0.68 * r


def plant(r, seed):
    pot, _ = bowl(0.8 * r, seed % 3 + 3)  # of metal or glazed green
    return [*pot, ("Grass", LEAF, tuft(seed, r, 1.6 * r))], 0.0


# Thing, its height over its radius, how often.
THINGS = ((stone, 1.3, 4), (sack, 1.2, 2), (crate, 1.0, 2), (book, 0.3, 2), (jar, 1.8, 3), (bowl, 0.6, 2), (hoop, 0.35, 1),
          (knot, 1.4, 1), (plant, 1.6, 2))


def lamp(at):
    """A shade, the two triangles that shine out of it, and its cord: (name, material, shape, place)."""
    x, y, z = at
    shade = lathe([(0.04, 0.28), (0.10, 0.27), (0.28, 0.02), (0.30, 0.0), (0.29, 0.0), (0.27, 0.02), (0.09, 0.25), (0.03, 0.26)])
    cord = ball((0.006, (3.0 - y - 0.28) / 2, 0.006), 8.0)
    return [
        ("Shade", METALS[0], shade.displaced(1, 0.003, 0.1), at),
        ("Cord", DARK_WOOD, cord, (x, (3.0 + y + 0.28) / 2, z)),
    ], rectangle((x - 0.15, y + 0.06, z - 0.15), (0.3, 0, 0), (0, 0, 0.3))

