# SPDX-License-Identifier: Apache-2.0
"""Procedural textures of the kitchen: all repeat without a seam and come from integer hashes alone."""

import math

from modelling.material import Texture
from modelling.png import encode_png


def noise(*keys):
    """A repeatable number in [0, 1) for small integers."""
    h = 2166136261
    for k in keys:
        h = ((h ^ (k & 0xFFFFFFFF)) * 16777619) & 0xFFFFFFFF
        h ^= h >> 13
    h = (h * 0x85EBCA6B) & 0xFFFFFFFF
    return (h ^ (h >> 16)) / 2**32


def tone(color, factor):
    return tuple(c * factor for c in color)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def floor_tiles():
    """Checked tiles of 1/3 m with grout lines, eight by eight, each with a shade of its own."""
    tile, count = 48, 8
    cream, clay, grout = (0.74, 0.68, 0.56), (0.36, 0.42, 0.47), (0.40, 0.38, 0.35)

    def pixel(x, y):
        i, j = x // tile, y // tile
        if x % tile == 0 or y % tile == 0:
            return grout
        color = cream if (i + j) % 2 else clay
        return tone(color, 0.93 + 0.13 * noise(1, i, j))

    return Texture("Floor tiles", encode_png(tile * count, tile * count, pixel), (count / 3, count / 3))


def grain(x, y, width, seed):
    """Streaks along x: slowly wandering lines, 0 to 1."""
    wander = 1.5 * math.sin(2 * math.pi * x / width + seed) + math.sin(4 * math.pi * x / width + 2.3 * seed)
    line = y + wander
    i = math.floor(line)
    t = line - i
    return noise(7, int(seed * 10), i) * (1 - t) + noise(7, int(seed * 10), i + 1) * t


def oak_staves():
    """A worktop glued of staves, 4 cm by 40 to 60 cm."""
    width, height, rows = 256, 128, 8
    light, dark = (0.60, 0.41, 0.23), (0.43, 0.26, 0.125)

    def pixel(x, y):
        row = y * rows // height
        shift = int(noise(2, row) * width)
        stave = ((x + shift) % width) * 3 // width
        edge = y % (height // rows) == 0 or ((x + shift) % width) * 3 % width < 3
        shade = 0.65 * noise(3, row, stave) + 0.35 * grain(x, y, width, 1.0 + row)
        color = mix(light, dark, math.floor(shade * 20) / 20)
        return tone(color, 0.72) if edge else color

    return Texture("Oak staves", encode_png(width, height, pixel), (1.28, 0.32))


def pine():
    """Planks of 15 cm."""
    width, height, planks = 256, 128, 4
    light, dark = (0.72, 0.53, 0.30), (0.58, 0.37, 0.17)

    def pixel(x, y):
        plank = y * planks // height
        shade = 0.3 * noise(4, plank) + 0.7 * grain(x, y * 0.5, width, 11.0 + plank)
        color = mix(light, dark, math.floor(shade * 20) / 20)
        return tone(color, 0.6) if y % (height // planks) == 0 else color

    return Texture("Pine", encode_png(width, height, pixel), (1.5, 0.6))


def tea_towel():
    size = 64
    white, red = (0.80, 0.79, 0.75), (0.68, 0.07, 0.05)

    def pixel(x, y):
        across, along = (x // 8) % 2, (y // 8) % 2
        return mix(white, red, (across + along) / 2)

    return Texture("Tea towel", encode_png(size, size, pixel), (0.20, 0.20))


def rug():
    stripes = [
        (0.70, 0.12, 0.08),
        (0.80, 0.74, 0.60),
        (0.80, 0.52, 0.06),
        (0.06, 0.32, 0.38),
        (0.80, 0.74, 0.60),
        (0.68, 0.26, 0.06),
        (0.06, 0.32, 0.38),
        (0.80, 0.74, 0.60),
    ]
    return Texture("Rug", encode_png(8, 64, lambda x, y: tone(stripes[y // 8], 0.92 if y % 2 else 1.0)), (0.5, 0.62))


def poster():
    """A pear, a lemon and a cherry in flat colours."""
    width, height = 192, 256
    paper, ochre, red, blue = (0.80, 0.76, 0.66), (0.80, 0.53, 0.05), (0.68, 0.06, 0.04), (0.05, 0.22, 0.42)

    def shape(x, y):
        if y > 200:
            return blue if y < 240 else paper
        if math.hypot(x - 70, y - 140) < 46 or math.hypot(x - 74, y - 84) < 26 + (y - 84) * 0.25:
            return (0.40, 0.56, 0.10)
        if math.hypot((x - 132) / 1.25, y - 164) < 27:
            return ochre
        if math.hypot(x - 136, y - 70) < 19 or math.hypot(x - 164, y - 86) < 19:
            return red
        if abs(math.hypot(x - 176, y - 62) - 40) < 1.5 and y < 62 and x < 176:
            return blue
        return paper if 8 <= x < width - 8 and y >= 8 else (0.80, 0.79, 0.76)

    return Texture("Poster", encode_png(width, height, shape), (1.0, 1.0))


FLOOR_TILES = floor_tiles()
OAK_STAVES = oak_staves()
PINE = pine()
TEA_TOWEL = tea_towel()
RUG = rug()
POSTER = poster()
