# SPDX-License-Identifier: Apache-2.0
"""Crockery, jars, bottles, fruit: turned shapes, standing on their local y = 0."""

import math

from modelling.shapes import sheet, tube
from modelling.surface import Model
from modelling.sweep import lathe

from . import palette as p
from .kit import arc_points


def mug(glaze, inside=p.PORCELAIN, segments=12):
    r, h = 0.04, 0.09
    outer = lathe([(0.0, 0.001), (r - 0.004, 0.0), (r, 0.005), (r, h - 0.002), (r - 0.0015, h)], segments)
    inner = lathe([(r - 0.0015, h), (r - 0.004, h - 0.002), (r - 0.004, 0.01), (0.0, 0.008)], segments)
    ear = tube(
        [
            (r - 0.002, 0.072, 0),
            (r + 0.018, 0.07, 0),
            (r + 0.026, 0.048, 0),
            (r + 0.018, 0.027, 0),
            (r - 0.002, 0.023, 0),
        ],
        0.005,
        5,
        caps=(False, False),
        up=(0, 0, 1),
    )
    return Model((glaze, outer), (inside, inner), (glaze, ear))


def plate(radius=0.13, segments=23):
    r = radius
    profile = [
        (r * 0.55, 0.0),
        (r * 0.62, 0.004),
        (r * 0.97, 0.018),
        (r, 0.0205),
        (r * 0.975, 0.022),
        (r * 0.66, 0.0085),
        (0.0, 0.0065),
    ]
    return lathe(profile, segments, crease=70)


def bowl(radius, height, segments=17, thickness=0.004):
    r, h, t = radius, height, thickness
    profile = [
        (r * 0.46, 0.0),
        (r * 0.50, h * 0.08),
        (r * 0.82, h * 0.40),
        (r, h),
        (r - t, h),
        (r * 0.82 - t, h * 0.40),
        (r * 0.45, t + h * 0.08),
        (0.0, t + h * 0.05),
    ]
    return lathe(profile, segments, crease=75)


def tumbler(segments=16):
    """One sheet of glass: its wall is a single pane; the foot is solid and shows as a second, upper pane."""
    wall = lathe([(0.030, 0.0), (0.031, 0.004), (0.036, 0.095), (0.0365, 0.11)], segments)
    floor = lathe([(0.0315, 0.012), (0.0, 0.011)], segments)
    return Model((p.BLUE_GLASS, wall), (p.BLUE_GLASS, floor))


def jar(filling, fill=0.7, radius=0.05, height=0.15, lid=p.STEEL, segments=10):
    """A glass jar, its filling a millimetre inside the wall, a lid that overlaps the neck."""
    r, h = radius, height
    wall = lathe([(r - 0.004, 0.0), (r, 0.006), (r, h - 0.012), (r - 0.008, h)], segments)
    inside = lathe(
        [(r - 0.002, 0.002), (r - 0.0015, h * fill), (r * 0.55, h * fill + 0.006), (0.0, h * fill + 0.008)], segments
    )
    cover = lathe(
        [(0.0, h - 0.004), (r - 0.002, h - 0.004), (r - 0.002, h + 0.014), (r - 0.005, h + 0.018), (0.0, h + 0.018)],
        segments,
    )
    return Model((p.GLASS, wall), (filling, inside), (lid, cover))


def tin(paint, radius=0.026, height=0.085, segments=9, lid=p.STEEL):
    r, h = radius, height
    body = lathe([(r, 0.0), (r, h)], segments)
    cover = lathe(
        [(r, h), (r + 0.0015, h + 0.001), (r + 0.0015, h + 0.012), (r - 0.002, h + 0.015), (0.0, h + 0.015)], segments
    )
    return Model((paint, body), (lid, cover))


def bottle(glass, radius, height, neck, segments=11, cap=p.BLACK, label=p.PAPER):
    r, h, n = radius, height, neck
    wall = lathe(
        [
            (r - 0.005, 0.0),
            (r, 0.006),
            (r, h * 0.58),
            (r * 0.88, h * 0.65),
            (n * 1.3, h * 0.74),
            (n, h * 0.80),
            (n, h * 0.955),
        ],
        segments,
    )
    cork = lathe([(n + 0.002, h * 0.93), (n + 0.002, h * 0.995), (n, h), (0.0, h)], 9)
    model = Model((glass, wall), (cap, cork))
    if label:
        model.add(label, lathe([(r + 0.0006, h * 0.16), (r + 0.0006, h * 0.46)], segments))
    return model


def fruit(radius, segments=13, rings=7, squash=0.95, dimple=0.1, point=0.0):
    """A ball dented at the top (dimple) or drawn out at both ends (point)."""
    profile = []
    for i in range(rings + 1):
        a = math.pi * (i / rings - 0.5)
        r, y = math.cos(a) * radius, math.sin(a) * radius * squash
        if i in (0, rings):
            r = 0.0
        y *= 1.0 + point * abs(math.sin(a)) ** 6
        y -= dimple * radius * max(0.0, math.sin(a)) ** 8
        profile.append((r, y + radius * squash))
    return lathe(profile, segments, crease=80)


def stalk(height, top):
    return tube(
        [(0, top - 0.004, 0), (0.001, top + height * 0.5, 0), (0.004, top + height, 0)],
        0.0018,
        5,
        caps=(False, True),
        up=(1, 0, 0),
    )


def banana(length=0.17, sides=6):
    path = arc_points((0, 0, 0), length / 1.6, 215, 325, 7, "xy")
    radii = [0.005, 0.008, 0.0145, 0.017, 0.017, 0.0145, 0.007, 0.004]
    return tube(path, radii, sides, up=(0, 0, 1))


def leaf(length, width, droop, steps=3):
    """A pointed leaf growing along +x from the origin and bending down, one sheet."""

    def f(s, t):
        x = length * s
        half = width / 2 * math.sin(math.pi * min(s * 0.94 + 0.06, 1.0)) ** 0.8 if s < 1.0 else 0.0
        z = half * (1 - 2 * t)
        return (x, -droop * s * s + abs(z) * 0.35, z)

    return sheet(f, steps, 2)
