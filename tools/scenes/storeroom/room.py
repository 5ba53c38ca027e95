# SPDX-License-Identifier: Apache-2.0
"""The room and what it is filled with: pieces whose places and sizes depend on their number alone, so that a larger scene
has the same pieces as a smaller one, finer, and more small things between them."""

import math
import random
from dataclasses import dataclass

import numpy as np

from modelling.material import matte

from . import things
from .shapes import Shape, ball, noise, rectangle, sheet

WIDTH, HEIGHT, DEPTH = 9.0, 3.0, 7.0  # metres: x, y, z
EYE, TARGET = (8.3, 1.65, 6.3), (2.6, 0.85, 1.8)
PLASTER = matte("Plaster", (0.80, 0.77, 0.70))
FLAGS = matte("Flagstones", (0.48, 0.43, 0.37))
CURTAIN = matte("Curtain", (0.50, 0.10, 0.12), double_sided=True)


@dataclass
class Piece:
    name: str
    material: object
    shape: Shape
    at: tuple = (0.0, 0.0, 0.0)
    turn: tuple = ()
    area: float = 1.0  # about, m^2: the larger the more triangles


def _flagstones(x, z):
    """Stones of 0.6 x 0.9 m with joints between them, every other row shifted."""
    row = np.floor(z / 0.6)
    u, v = (x / 0.9 + 0.5 * (row % 2)) % 1, (z / 0.6) % 1
    edge = np.minimum(np.minimum(u, 1 - u) * 0.9, np.minimum(v, 1 - v) * 0.6)
    return -0.012 * np.exp(-((edge / 0.012) ** 2))


def shell():
    """Six rough sheets that reach through each other at the edges, so that the room is closed."""
    over = 0.1
    low, wide, high, deep = -over, WIDTH + 2 * over, HEIGHT + 2 * over, DEPTH + 2 * over
    rough = lambda shape, seed: shape.displaced(seed, 0.02, 0.7)
    floor = sheet(lambda s, t: (low + wide * s, _flagstones(wide * s, deep * (1 - t)), low + deep * (1 - t)), 1)
    ceiling = rectangle((low, HEIGHT, low), (wide, 0, 0), (0, 0, deep))
    walls = [
        rectangle((low, low, 0), (wide, 0, 0), (0, high, 0), 3),
        rectangle((WIDTH, low, low), (0, 0, deep), (0, high, 0), 2),
        rectangle((WIDTH + over, low, DEPTH), (-wide, 0, 0), (0, high, 0), 3),
        rectangle((0, low, DEPTH + over), (0, 0, -deep), (0, high, 0), 2),
    ]
    yield Piece("Floor", FLAGS, floor.displaced(1, 0.006, 0.5), area=60)
    yield Piece("Ceiling", PLASTER, rough(ceiling, 2), area=20)
    for i, wall in enumerate(walls):
        yield Piece(f"Wall {i + 1}", PLASTER, rough(wall, 3 + i), area=20)
    for i in range(5):
        beam = ball((WIDTH / 2 + 0.1, 0.11, 0.09), 24.0).displaced(i, 0.012, 0.3)
        yield Piece(f"Beam {i + 1}", things.DARK_WOOD, beam, (WIDTH / 2, HEIGHT - 0.08, 0.7 + 1.4 * i), area=3)


def _folds(s, t):
    depth = 0.06 * (0.4 + 0.6 * (1 - t)) * np.sin(2 * math.pi * 7 * s + 1.5 * np.sin(3 * s)) + 0.02 * np.sin(9 * s + 4 * t)
    return 1.9 * s, 2.55 * t, depth


SHELF_HEIGHTS = (0.30, 0.78, 1.26, 1.74, 2.22)
SHELVES = ((0.4, 0.3, 6.2, 0.42, 0), (0.3, 6.4, 5.4, 0.42, 90))  # x, z of the left front foot, width, depth, turn
TABLES = ((3.7, 3.1, 2.0, 0.95), (6.9, 1.7, 1.7, 0.9))  # x, z of the middle, width, depth


def furniture():
    for x, z, width, depth, turn in SHELVES:
        along = (0, -1) if turn else (1, 0)
        spin = (("y", turn),) if turn else ()
        for height in SHELF_HEIGHTS:
            board = ball((width / 2, 0.018, depth / 2), 24.0).displaced(round(100 * height), 0.003, 0.2)
            middle = (x + along[0] * width / 2, height - 0.018, z + along[1] * width / 2)
            yield Piece("Board", things.WOOD, board, middle, spin, width * depth)
        for i in range(4):
            post = ball((0.03, 1.25, depth / 2), 24.0).displaced(i, 0.003, 0.2)
            at = width * (0.01 + 0.98 * i / 3)
            yield Piece("Post", things.WOOD, post, (x + along[0] * at, 1.25, z + along[1] * at), spin, 0.8)
    for x, z, width, depth in TABLES:
        top = ball((width / 2, 0.03, depth / 2), 24.0).displaced(9, 0.004, 0.3)
        yield Piece("Table top", things.DARK_WOOD, top, (x, 0.73, z), area=4)
        for sx, sz in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
            leg = ball((0.05, 0.38, 0.05), 10.0).displaced(5, 0.006, 0.2)
            yield Piece("Leg", things.DARK_WOOD, leg, (x + sx * (width / 2 - 0.1), 0.36, z + sz * (depth / 2 - 0.1)), area=0.3)
    yield Piece("Curtain", CURTAIN, sheet(_folds, 2).displaced(7, 0.02, 0.5), (6.95, 0.05, 0.15), area=10)


LAMPS = ((2.0, 2.2, 2.2), (5.0, 2.25, 4.3), (7.0, 2.2, 1.7))


def lamps():
    """The shades and cords; the shining rectangles, which stay two triangles each, are in lights()."""
    for lamp in LAMPS:
        for name, material, shape, at in things.lamp(lamp)[0]:
            yield Piece(name, material, shape, at, area=0.5 if name == "Shade" else 0.02)


def lights():
    return [things.lamp(lamp)[1] for lamp in LAMPS]


@dataclass
class Support:
    """A level rectangle that things stand on."""

    x: tuple
    y: float
    z: tuple
    clearance: float
    share: float  # of the things

    def __post_init__(self):
        self.taken = []

    def place(self, r, dice):
        """A free spot for a disc of radius r, or None."""
        if min(self.x[1] - self.x[0], self.z[1] - self.z[0]) < 2 * r:
            return None
        for _ in range(30):
            x, z = dice.uniform(self.x[0] + r, self.x[1] - r), dice.uniform(self.z[0] + r, self.z[1] - r)
            near_eye = math.hypot(x - EYE[0], z - EYE[2]) < 1.3 + r
            if not near_eye and all(math.hypot(x - a, z - b) > r + s for a, b, s in self.taken):
                self.taken.append((x, z, r))
                return x, self.y, z
        return None


def _supports():
    floor = [((0.9, 2.5), (0.8, 6.6)), ((2.6, 8.4), (3.9, 6.8)), ((5.0, 8.7), (2.4, 3.9)), ((2.6, 5.8), (0.7, 2.4))]
    result = [Support(x, 0.0, z, 1.6, 0.12) for x, z in floor]
    for x, z, width, depth in TABLES:
        result.append(Support((x - width / 2, x + width / 2), 0.76, (z - depth / 2, z + depth / 2), 0.7, 0.09))
    for x, z, width, depth, turn in SHELVES:
        for height in SHELF_HEIGHTS:
            rect = ((x, x + width), (z - depth / 2, z + depth / 2))
            if turn:
                rect = ((x - depth / 2, x + depth / 2), (z - width, z))
            result.append(Support(rect[0], height, rect[1], 0.42, 0.034))
    return result


def radius(number):
    """Of thing number 0, 1, 2 ..., metres: many small ones between few large ones."""
    return 0.5 * (1 + number) ** -0.33


def clutter(count):
    supports = _supports()
    dice = random.Random(2003)
    kinds = [thing for thing in things.THINGS for _ in range(thing[2])]
    for number in range(count):
        thing, tallness, _ = dice.choice(kinds)
        r, spot = radius(number), None
        while spot is None:
            open_ones = [s for s in supports if s.clearance > tallness * r]
            support = dice.choices(open_ones, [s.share for s in open_ones])[0]
            spot = support.place(r, dice)
            if spot is None:
                r *= 0.9
        parts, middle = thing(r, number)
        turn = (("y", dice.uniform(0, 360)),)
        for name, material, shape in parts:
            yield Piece(f"{name} {number + 1}", material, shape, (spot[0], spot[1] + middle, spot[2]), turn, 4 * r * r)


def pieces(triangles):
    count = round(150 * math.sqrt(triangles / 30000))
    return [*shell(), *furniture(), *lamps(), *clutter(count)]


def levels(pieces, triangles):
    """How finely to make each piece so that all together have about so many triangles: large pieces get more of them,
    but fewer for each square metre, as what is small is often looked at from near."""
    weights = [piece.area**0.6 for piece in pieces]

    def at(scale):
        return [piece.shape.level(scale * weight) for piece, weight in zip(pieces, weights)]

    low, high = 0.0, float(triangles)
    for _ in range(60):
        middle = (low + high) / 2
        total = sum(piece.shape.count(level) for piece, level in zip(pieces, at(middle)))
        low, high = (middle, high) if total < triangles else (low, middle)
    return at(high)
