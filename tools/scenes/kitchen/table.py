# SPDX-License-Identifier: Apache-2.0
"""The table, laid for four: places, fruit, flowers."""

import math

from modelling.shapes import tube
from modelling.surface import Model, Surface
from modelling.sweep import lathe, rectangle, slab, sweep

from . import palette as p
from . import vessels
from .kit import SINK, TABLE_HEIGHT
from .textures import noise

RUG_HEIGHT = 0.007
CENTRE = (2.15, RUG_HEIGHT - SINK, 2.15)
LENGTH, WIDTH = 1.50, 0.90
# Place settings and their chairs: position of the table's edge in its own frame, turn about y.
PLACES = ((-0.36, -WIDTH / 2, 180), (0.36, -WIDTH / 2, 180), (-0.36, WIDTH / 2, 0), (0.36, WIDTH / 2, 0))


def build(scene):
    with scene.group("Table", at=CENTRE):
        top = slab(LENGTH, WIDTH, 0.03, 0.005, 0.06, 4, bottom=True)
        scene.add("Table top", Model((p.TABLE_WOOD, top)), at=(0, TABLE_HEIGHT - 0.03, 0))
        apron = sweep(rectangle(LENGTH - 0.20, WIDTH - 0.20), [(-0.02, -0.09), (0.0, -0.088), (0.0, 0.0)])
        inside = sweep(rectangle(LENGTH - 0.24, WIDTH - 0.24), [(0.0, 0.0), (0.0, -0.09)])
        scene.add("Table apron", Model((p.WOODWORK, apron), (p.WOODWORK, inside)), at=(0, TABLE_HEIGHT - 0.03, 0))
        turned = lathe(
            [
                (0.018, 0.0),
                (0.022, 0.02),
                (0.034, 0.5),
                (0.026, 0.53),
                (0.036, 0.55),
                (0.036, 0.565),
                (0.03, 0.58),
                (0.036, 0.60),
                (0.036, TABLE_HEIGHT - 0.03),
            ],
            10,
        )
        leg = Model((p.WOODWORK, turned))
        for i, (sx, sz) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
            scene.add(f"Table leg {i + 1}", leg, at=(sx * (LENGTH / 2 - 0.11), 0, sz * (WIDTH / 2 - 0.11)))
        with scene.group("On the table", at=(0, TABLE_HEIGHT - SINK, 0)):
            settings(scene)
            fruit_bowl(scene)
            flowers(scene)
            drinks(scene)
    rug = sweep(rectangle(2.3, 1.9, 0.01, 1), [(0.0, 0.0), (-0.004, RUG_HEIGHT)], cap_end=True)
    scene.add("Rug", Model((p.RUG, rug)), at=(CENTRE[0], 0, CENTRE[2]))


def settings(scene):
    mats = (p.RED, p.SKY_BLUE, p.YELLOW_MATTE, p.GREEN)
    plate, soup = vessels.plate(), vessels.bowl(0.075, 0.045)
    fork_, knife_, spoon_, tumbler = fork(), knife(), spoon(), vessels.tumbler()
    for i, (x, z, turn) in enumerate(PLACES):
        with scene.group(f"Place {i + 1}", at=(x, 0, z), turn=[("y", turn)]):
            mat = sweep(rectangle(0.42, 0.31, 0.02, 2), [(0.0, 0.0), (-0.001, 0.002)], cap_end=True)
            scene.add(f"Place mat {i + 1}", Model((mats[i], mat)), at=(0, 0, -0.185))
            y = 0.002
            scene.add(f"Plate {i + 1}", Model((p.PORCELAIN, plate)), at=(0, y - SINK, -0.18))
            glaze = (p.YELLOW, p.BLUE_GLAZE, p.BLUE_GLAZE, p.YELLOW)[i]
            scene.add(f"Soup bowl {i + 1}", Model((glaze, soup)), at=(0, y + 0.0063 - SINK, -0.18))
            scene.add(f"Fork {i + 1}", fork_, at=(-0.165, y + 0.001, -0.18))
            scene.add(f"Knife {i + 1}", knife_, at=(0.155, y + 0.0002, -0.18))
            scene.add(f"Spoon {i + 1}", spoon_, at=(0.185, y + 0.001, -0.18))
            scene.add(f"Tumbler {i + 1}", tumbler, at=(0.13, 0, -0.375))


def grip(length):
    """Flat bar along z, from the hand's end at z = length / 2."""
    h = length / 2
    return [(0, 0.004, h), (0, 0.0045, h - 0.02), (0, 0.005, 0.0)]


def fork():
    handle = tube(
        grip(0.19) + [(0, 0.006, -0.03), (0, 0.004, -0.045)],
        [0.0075, 0.006, 0.0035, 0.004, 0.010],
        6,
        flatten=0.3,
        up=(0, 1, 0),
        caps=(True, True),
    )
    tines = Surface()
    for x in (-0.0085, -0.003, 0.003, 0.0085):
        tines.extend(
            tube(
                [(x, 0.004, -0.043), (x, 0.0035, -0.07), (x, 0.006, -0.095)],
                [0.0022, 0.002, 0.0008],
                4,
                flatten=0.7,
                up=(0, 1, 0),
                caps=(False, True),
            )
        )
    return Model((p.CHROME, handle), (p.CHROME, tines))


def knife():
    handle = tube(grip(0.21), [0.008, 0.007, 0.005], 6, flatten=0.5, up=(0, 1, 0))
    blade = sweep(rectangle(0.016, 0.115), [(0.0, 0.003), (-0.001, 0.0045)], cap_end=True, cap_start=True).moved(
        0, 0, -0.055
    )
    return Model((p.CHROME, handle), (p.CHROME, blade))


def spoon():
    path = grip(0.19) + [
        (0, 0.006, -0.035),
        (0, 0.005, -0.045),
        (0, 0.005, -0.065),
        (0, 0.005, -0.085),
        (0, 0.006, -0.094),
    ]
    return Model(
        (p.CHROME, tube(path, [0.0075, 0.006, 0.0035, 0.004, 0.013, 0.019, 0.014, 0.004], 7, flatten=0.2, up=(0, 1, 0)))
    )


def fruit_bowl(scene):
    with scene.group("Fruit", at=(0.0, 0, 0.0)):
        scene.add("Fruit bowl", Model((p.YELLOW, vessels.bowl(0.15, 0.08, 25, 0.006))))
        y = 0.016
        orange, lemon = vessels.fruit(0.038), vessels.fruit(0.028, 12, 8, 1.15, 0.0, 0.14)
        apple = vessels.fruit(0.036, 14, 8, 0.9, 0.35)
        with_stalk = lambda skin: Model((skin, apple), (p.DARK_WOOD, vessels.stalk(0.016, 0.055)))
        for name, model, x, h, z, turn in (
            ("Orange 1", Model((p.PEEL_ORANGE, orange)), -0.045, y, -0.045, (10, 0)),
            ("Orange 2", Model((p.PEEL_ORANGE, orange)), 0.048, y + 0.002, -0.038, (-20, 15)),
            ("Apple 1", with_stalk(p.APPLE_RED), 0.042, y + 0.004, 0.046, (12, 30)),
            ("Apple 2", with_stalk(p.APPLE_GREEN), -0.042, y + 0.003, 0.056, (-14, 60)),
            ("Lemon 1", Model((p.PEEL_LEMON, lemon)), 0.09, y + 0.06, 0.0, (80, 20)),
            ("Orange 3", Model((p.PEEL_ORANGE, orange)), 0.010, y + 0.056, 0.0, (30, 0)),
        ):
            scene.add(name, model, at=(x, h, z), turn=[("x", turn[0]), ("y", turn[1])])
        bananas = Surface()
        for k in range(3):
            bananas.extend(vessels.banana().turned(("x", 20 * k - 20)).moved(-0.088, 0.193, 0.006))
        scene.add("Bananas", Model((p.BANANA, bananas)))


def flowers(scene):
    with scene.group("Flowers", at=(-0.30, 0, 0.0)):
        vase = lathe(
            [
                (0.036, 0.0),
                (0.042, 0.006),
                (0.05, 0.05),
                (0.036, 0.10),
                (0.022, 0.135),
                (0.026, 0.16),
                (0.0235, 0.161),
                (0.019, 0.135),
                (0.0, 0.12),
            ],
            14,
        )
        scene.add("Vase", Model((p.PORCELAIN, vase)))
        petals, hearts, stems = Surface(), Surface(), Surface()
        for k in range(6):
            a, lean = 2 * math.pi * k / 6 + 0.3, 0.035 + 0.045 * noise(30, k)
            top = (lean * math.cos(a), 0.27 + 0.06 * noise(31, k), lean * math.sin(a))
            stems.extend(
                tube(
                    [(0, 0.11, 0), (top[0] * 0.3, 0.19, top[2] * 0.3), top],
                    0.0018,
                    4,
                    caps=(False, False),
                    up=(1, 0, 0),
                )
            )
            tilt = 35 + 20 * noise(32, k)
            place = lambda s: s.turned(("z", -tilt), ("y", -math.degrees(a))).moved(*top)
            for m in range(6):
                petals.extend(place(vessels.leaf(0.03, 0.022, -0.006, 2).turned(("y", 60 * m))))
            hearts.extend(place(lathe([(0.009, -0.001), (0.006, 0.004), (0.0, 0.005)], 7)))
        scene.add("Flowers", Model((p.FLOWER, petals), (p.PEEL_LEMON, hearts), (p.HERB, stems)))


def drinks(scene):
    jug = lathe(
        [(0.045, 0.0), (0.05, 0.006), (0.058, 0.05), (0.052, 0.12), (0.04, 0.17), (0.042, 0.205), (0.048, 0.225)], 16
    )
    ear = tube(
        [(0.05, 0.19, 0), (0.085, 0.185, 0), (0.095, 0.14, 0), (0.08, 0.09, 0), (0.056, 0.075, 0)],
        0.006,
        7,
        caps=(False, False),
        up=(0, 0, 1),
    )
    juice = lathe([(0.044, 0.003), (0.049, 0.008), (0.0568, 0.05), (0.0525, 0.11), (0.0, 0.11)], 16)
    scene.add(
        "Jug", Model((p.GLASS, jug), (p.GLASS, ear), (p.PEEL_ORANGE, juice)), at=(0.30, 0, 0.03), turn=[("y", 40)]
    )
    mill = lathe([(0.018, 0.0), (0.02, 0.005), (0.013, 0.04), (0.016, 0.055)], 10)
    cap = lathe([(0.0165, 0.055), (0.014, 0.066), (0.0, 0.07)], 10)
    for name, x, z, clay in (("Salt", 0.195, 0.10, p.PORCELAIN), ("Pepper", 0.242, 0.118, p.TERRACOTTA)):
        scene.add(name, Model((clay, mill), (p.CHROME, cap)), at=(x, 0, z))
