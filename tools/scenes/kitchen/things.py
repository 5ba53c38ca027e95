# SPDX-License-Identifier: Apache-2.0
"""What stands on the worktop and on the window board."""

import math

from modelling.shapes import tube
from modelling.surface import Model, Surface
from modelling.sweep import lathe, rectangle, slab, sweep

from . import palette as p
from . import vessels
from .kit import SINK
from .kit import WORKTOP_HEIGHT as TOP
from .room import SILL_TOP
from .textures import noise


def build(scene):
    with scene.group("On the worktop", at=(0, TOP - SINK, 0)):
        utensils(scene)
        bottles(scene)
        knives(scene)
        bread(scene)
        roll(scene)
    with scene.group("On the window board", at=(0, SILL_TOP - SINK, 0)):
        plants(scene)


def utensils(scene):
    with scene.group("Utensils", at=(0.72, 0, 0.20)):
        pot = lathe(
            [
                (0.05, 0.0),
                (0.055, 0.006),
                (0.06, 0.13),
                (0.062, 0.15),
                (0.059, 0.152),
                (0.056, 0.148),
                (0.05, 0.02),
                (0.0, 0.02),
            ],
            14,
        )
        scene.add("Utensil pot", Model((p.ORANGE, pot)))
        handle = lambda length, r, cap=True: tube(
            [(0, 0, 0), (0, length * 0.5, 0), (0, length, 0)],
            [r, r * 0.9, r * 0.8],
            6,
            caps=(False, cap),
            up=(0, 0, 1),
        )
        bowl = vessels.fruit(0.03, 8, 6, 1.3, 0.0)
        spoon = Surface().extend(handle(0.24, 0.006, cap=False)).extend(bowl.moved(0, 0.235, 0))
        spatula = (
            Surface().extend(handle(0.22, 0.006)).extend(slab(0.06, 0.006, 0.09, 0.002, bottom=True).moved(0, 0.218, 0))
        )
        ladle = Model(
            (p.STEEL, handle(0.27, 0.005)),
            (p.STEEL, vessels.bowl(0.036, 0.036, 9, 0.002).turned(("z", 90)).moved(0.03, 0.265, 0)),
        )
        whisk = Surface().extend(handle(0.14, 0.008))
        for k in range(3):
            a = math.pi * k / 3
            loop = [
                (
                    0.034 * math.sin(math.pi * s / 5) * c,
                    0.14 + 0.07 * (1 - math.cos(math.pi * s / 5)),
                    0.034 * math.sin(math.pi * s / 5) * d,
                )
                for s in range(6)
                for c, d in ((math.cos(a), math.sin(a)),)
            ]
            back = [(-x, y, -z) for x, y, z in loop[-2::-1]]
            whisk.extend(tube(loop + back, 0.0014, 4, caps=(False, False), up=(0.3, 0.1, 1.0)))
        for name, model, turn, place in (
            ("Wooden spoon", Model((p.WOOD, spoon)), (14, 20), (0.015, -0.01)),
            ("Spatula", Model((p.DARK_WOOD, spatula)), (-13, -30), (-0.02, 0.012)),
            ("Ladle", ladle, (-10, 100), (0.0, -0.02)),
            ("Whisk", Model((p.CHROME, whisk)), (12, -80), (0.012, 0.018)),
        ):
            scene.add(name, model, at=(place[0], 0.024, place[1]), turn=[("z", turn[0]), ("y", turn[1])])


def bottles(scene):
    for name, x, z, model in (
        ("Olive oil", 0.96, 0.13, vessels.bottle(p.GREEN_GLASS, 0.034, 0.29, 0.013)),
        ("Vinegar", 1.05, 0.11, vessels.bottle(p.BROWN_GLASS, 0.030, 0.24, 0.012, cap=p.RED, label=p.YELLOW_MATTE)),
        ("Wine", 0.875, 0.09, vessels.bottle(p.GREEN_GLASS, 0.038, 0.31, 0.014, cap=p.VIOLET)),
    ):
        scene.add(name, model, at=(x, 0, z))
    mill = lathe(
        [
            (0.027, 0.0),
            (0.028, 0.015),
            (0.02, 0.05),
            (0.018, 0.09),
            (0.024, 0.12),
            (0.024, 0.135),
            (0.02, 0.14),
            (0.022, 0.155),
            (0.014, 0.175),
            (0.0, 0.18),
        ],
        10,
    )
    scene.add("Pepper mill", Model((p.DARK_WOOD, mill)), at=(1.03, 0, 0.24))


def knives(scene):
    """A block that leans back with five handles, on the worktop right of the hob."""
    with scene.group("Knives", at=(1.93, 0, 0.15), turn=[("y", 20)]):
        block = slab(0.10, 0.13, 0.20, 0.005, bottom=True).turned(("x", -18)).moved(0, 0.02, 0)
        foot = slab(0.10, 0.12, 0.03, 0.004).moved(0, 0, 0.02)
        scene.add("Knife block", Model((p.DARK_WOOD, block), (p.DARK_WOOD, foot)))
        for k in range(5):
            x, z = (-0.03 + 0.03 * k, 0.03) if k < 3 else (-0.015 + 0.03 * (k - 3), -0.03)
            grip = sweep(rectangle(0.016, 0.026, 0.005, 1), [(0.0, -0.001), (0.0, 0.07), (-0.004, 0.078)], cap_end=True)
            scene.add(
                f"Kitchen knife {k + 1}", Model((p.BLACK, grip.moved(x, 0.20, z).turned(("x", -18)).moved(0, 0.02, 0)))
            )


def bread(scene):
    with scene.group("Bread", at=(2.08, 0, 0.42), turn=[("y", 8)]):
        board = slab(0.34, 0.22, 0.02, 0.004, 0.02, 2)
        scene.add("Cutting board", Model((p.WOOD, board)))
        path = [(-0.13, 0, 0), (-0.12, 0, 0), (-0.09, 0, 0), (-0.03, 0, 0), (0.03, 0, 0), (0.05, 0, 0)]
        loaf = tube(
            path, [0.012, 0.032, 0.048, 0.054, 0.054, 0.054], 12, flatten=0.85, up=(0, 1, 0), caps=(True, False)
        )
        cut = tube([(0.04, 0, 0), (0.05, 0, 0)], [0.054, 0.054], 12, flatten=0.85, up=(0, 1, 0))
        crumb = Surface()
        crumb.triangles = [t for t in cut.triangles if t[0][1][0] > 0.9]
        scene.add("Bread", Model((p.CRUST, loaf), (p.CREAM, crumb)), at=(-0.01, 0.062, -0.02))
        blade = sweep(rectangle(0.17, 0.026), [(0.0, 0.0), (-0.0008, 0.0016)], cap_end=True)
        grip = sweep(
            rectangle(0.11, 0.022, 0.006, 2), [(0.0, -0.001), (0.0, 0.008), (-0.004, 0.012)], cap_end=True
        ).moved(-0.14, 0, 0)
        scene.add(
            "Bread knife", Model((p.STEEL, blade), (p.BLACK, grip)), at=(0.05, 0.02 + SINK, 0.077), turn=[("y", 5)]
        )
        tomato = vessels.fruit(0.03, 10, 6, 0.82, 0.15)
        for k, (x, z) in enumerate(((0.105, -0.055), (0.12, 0.012))):
            scene.add(
                f"Tomato {k + 1}", Model((p.TOMATO, tomato), (p.GREEN, vessels.stalk(0.008, 0.044))), at=(x, 0.0195, z)
            )


def roll(scene):
    """On its stand."""
    with scene.group("Kitchen paper", at=(0.16, 0, 0.72)):
        foot = lathe([(0.07, 0.0), (0.07, 0.01), (0.066, 0.014), (0.0, 0.014)], 14)
        pole = lathe([(0.007, 0.014), (0.007, 0.29), (0.012, 0.295), (0.012, 0.31), (0.006, 0.316), (0.0, 0.316)], 8)
        paper = lathe([(0.058, 0.0), (0.058, 0.24), (0.021, 0.24), (0.021, 0.0)], 14)
        scene.add("Kitchen paper", Model((p.WOOD, foot), (p.WOOD, pole), (p.PAPER, paper.moved(0, 0.0135, 0))))


def plants(scene):
    pots = (
        (0.98, p.TERRACOTTA, p.HERB, 21, 0.075, 0.05, 0.11),
        (1.22, p.PORCELAIN, p.LEAF, 16, 0.15, 0.06, 0.14),
        (1.66, p.YELLOW, p.HERB, 20, 0.085, 0.045, 0.14),
    )
    for number, (z, clay, green, count, length, width, height) in enumerate(pots):
        with scene.group(f"Plant {number + 1}", at=(-0.02, 0, z)):
            pot = lathe(
                [(0.036, 0.0), (0.05, 0.075), (0.055, 0.076), (0.056, 0.096), (0.05, 0.096), (0.048, 0.084)], 13
            )
            soil = lathe([(0.048, 0.084), (0.0, 0.086)], 13)
            scene.add(f"Flower pot {number + 1}", Model((clay, pot), (p.EARTH, soil)))
            scene.add(f"Leaves {number + 1}", Model((green, foliage(number, count, length, width, height))))


def foliage(seed, count, length, width, height):
    """Leaves around a bundle of stalks."""
    surface = Surface()
    for k in range(count):
        level = (k + 0.5) / count
        size = length * (1.15 - 0.5 * level) * (0.85 + 0.3 * noise(20, seed, k))
        angle = 137.5 * k
        lift = 15 + 50 * level + 20 * (noise(21, seed, k) - 0.5)
        piece = vessels.leaf(size, width * (1.1 - 0.4 * level), size * 0.35)
        y = 0.088 + height * level
        surface.extend(
            piece.turned(("z", lift), ("y", angle)).moved(
                0.006 * math.cos(math.radians(angle)), y, -0.006 * math.sin(math.radians(angle))
            )
        )
    for k in range(3):
        a = 2.1 * k
        surface.extend(
            tube(
                [
                    (0.012 * math.cos(a), 0.083, 0.012 * math.sin(a)),
                    (0.004 * math.cos(a), 0.083 + height, 0.004 * math.sin(a)),
                ],
                0.0022,
                4,
                caps=(False, False),
                up=(1, 0, 0),
            )
        )
    return surface
