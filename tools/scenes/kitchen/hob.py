# SPDX-License-Identifier: Apache-2.0
"""Gas hob with pots and a kettle, oven below, extractor hood above."""

import math

from modelling.shapes import polygon, quad, sheet, tube
from modelling.surface import Model, Surface
from modelling.sweep import lathe, rectangle, sweep

from . import palette as p
from .cabinets import CARCASS_TOP, FRONT, OVEN_X0, OVEN_X1, PLINTH
from .kit import ROOM_HEIGHT, SINK
from .kit import WORKTOP_HEIGHT as TOP
from .kit import arc_points, bar_handle, facing, knob, plain_front

CENTRE_X, CENTRE_Z = 1.5, 0.315
GRATE_TOP = TOP + 0.042
BURNERS = [(-0.15, -0.12), (0.15, -0.12), (-0.15, 0.12), (0.15, 0.12)]


def build(scene):
    hob(scene)
    oven(scene)
    hood(scene)
    cookware(scene)


def hob(scene):
    with scene.group("Hob", at=(CENTRE_X, TOP, CENTRE_Z)):
        tray = sweep(
            rectangle(0.58, 0.50, 0.028, 2),
            [(0.0, -SINK), (0.0, 0.004), (-0.004, 0.008), (-0.018, 0.008), (-0.024, 0.005)],
            cap_end=True,
        )
        scene.add("Hob", Model((p.BRUSHED, tray)))
        burner = lathe([(0.045, 0.0), (0.043, 0.008), (0.032, 0.010), (0.032, 0.016), (0.0, 0.020)], 12)
        model = Model((p.IRON, burner))
        for i, (x, z) in enumerate(BURNERS):
            scene.add(f"Burner {i + 1}", model, at=(x, 0.005 - SINK, z))
        for side, x in (("left", -0.145), ("right", 0.145)):
            scene.add(f"Pan support {side}", Model((p.IRON, grate())), at=(x, 0.0, 0.0))


def grate():
    """Square bars on four feet; their top is at GRATE_TOP."""
    y, r = GRATE_TOP - TOP - 0.005, 0.005 * math.sqrt(2)
    surface = Surface()
    for x in (-0.125, 0.0, 0.125):
        surface.extend(tube([(x, y, -0.225), (x, y, 0.225)], r, 4, up=(1.0, 1.0, 0.0)))
    for z in (-0.215, -0.12, 0.12, 0.215):
        surface.extend(tube([(-0.122, y, z), (0.122, y, z)], r, 4, caps=(False, False), up=(0.0, 1.0, 1.0)))
    for x in (-0.125, 0.125):
        for z in (-0.21, 0.21):
            surface.extend(tube([(x, y, z), (x, 0.0046, z)], 0.006, 5, caps=(False, False), up=(1.0, 0.0, 0.0)))
    return surface


def oven(scene):
    x0, x1 = OVEN_X0 + 0.002, OVEN_X1 - 0.002
    width, top, bottom, panel = x1 - x0, CARCASS_TOP - 0.004, PLINTH + 0.01, 0.11
    with scene.group("Oven", at=((x0 + x1) / 2, 0, FRONT)):
        display = plain_front(0.12, 0.04, 0.003, 0.001).moved(0, 0, 0.025 - SINK)
        controls = Model((p.BRUSHED, plain_front(width, panel, 0.025)), (p.BLACK_GLASS, display))
        for x in (-0.24, -0.16, 0.16, 0.24):
            controls.add(p.CHROME, knob(0.021, 0.028, 8).moved(x, 0, 0.025))
        scene.add("Oven controls", controls, at=(0, top - panel / 2, 0))
        height = top - panel - 0.004 - bottom
        frame = facing(
            sweep(
                rectangle(width, height), [(0.0, 0.0), (0.0, 0.022), (-0.003, 0.025), (-0.055, 0.025), (-0.058, 0.0215)]
            )
        )
        inside = quad((-width / 2 + 0.058, -height / 2 + 0.058, 0.0215), (width - 0.116, 0, 0), (0, height - 0.116, 0))
        handle = bar_handle(0.48, 0.045, 0.009, 8, 2).moved(0, height / 2 - 0.03, 0.025)
        door = Model((p.BRUSHED, frame), (p.BLACK_GLASS, inside), (p.CHROME, handle))
        scene.add("Oven door", door, at=(0, bottom + height / 2, 0))
        scene.add("Towel", Model((p.TOWEL, towel())), at=(0.1, bottom + height - 0.03, 0.025 + 0.045))


def towel():
    """Folded over the oven's handle, whose axis is the local x axis."""
    r, front, back, width = 0.0125, 0.30, 0.20, 0.20
    arch = math.pi * r
    total = back + arch + front

    def cloth(s, t):
        along = total * t
        x = width * (s - 0.5)
        wave = 0.004 * math.sin(9.0 * x / width + 0.8)
        if along < back:
            return (x, along - back, -r)
        if along < back + arch:
            a = (along - back) / r
            return (x, r * math.sin(a), -r * math.cos(a))
        down = along - back - arch
        return (x * (1 + 0.1 * down), -down, r + wave * min(down / 0.1, 1.0) + 0.004 * min(down / 0.1, 1.0))

    return sheet(cloth, 6, 20, uv=lambda s, t: (width * s, total * t))


def hood(scene):
    """Pyramid with a chimney up to the ceiling; its back is the wall."""
    bottom, rim, neck = 1.56, 0.05, 1.86
    h, d, hn, dn = 0.30, 0.50, 0.12, 0.24
    rings = [
        [(-h, bottom, 0), (-h, bottom, d), (h, bottom, d), (h, bottom, 0)],
        [(-h, bottom + rim, 0), (-h, bottom + rim, d), (h, bottom + rim, d), (h, bottom + rim, 0)],
        [(-hn, neck, 0), (-hn, neck, dn), (hn, neck, dn), (hn, neck, 0)],
        [(-hn, ROOM_HEIGHT, 0), (-hn, ROOM_HEIGHT, dn), (hn, ROOM_HEIGHT, dn), (hn, ROOM_HEIGHT, 0)],
    ]
    with scene.group("Hood and chimney", at=(CENTRE_X, 0, 0)):
        walls = [Surface(), Surface(), Surface()]
        for surface, low, high in zip(walls, rings, rings[1:]):
            for i in range(3):
                surface.extend(polygon([low[i], low[i + 1], high[i + 1], high[i]]))
        model = Model().add(p.STEEL, walls[0], walls[1], underside(h, d, bottom))
        for i in range(3):
            model.add(p.BLACK, knob(0.008, 0.006, 6).moved(0.18 + 0.03 * i, bottom + rim / 2, d))
        scene.add("Extractor hood", model)
        scene.add("Chimney", Model((p.STEEL, walls[2])))


def underside(h, d, y):
    """A frame with the filter set back into it."""
    outer = [(-h, y, 0), (h, y, 0), (h, y, d), (-h, y, d)]
    m = 0.04
    inner = [(-h + m, y, m), (h - m, y, m), (h - m, y, d - m), (-h + m, y, d - m)]
    lift = [(a, b + 0.025, c) for a, b, c in inner]
    surface = polygon(lift)
    for i in range(4):
        k = (i + 1) % 4
        surface.extend(polygon([outer[i], outer[k], inner[k], inner[i]]))
        surface.extend(polygon([inner[i], inner[k], lift[k], lift[i]]))
    return surface


def pot(radius, height, segments, steel=p.STEEL, loops=True):
    """Closed body with its lid on; two loop handles."""
    r, h = radius, height
    body = lathe(
        [
            (0.0, 0.0),
            (r - 0.008, 0.0),
            (r - 0.002, 0.003),
            (r, 0.012),
            (r, h - 0.004),
            (r + 0.005, h),
            (r + 0.005, h + 0.003),
            (r - 0.004, h + 0.004),
        ],
        segments,
    )
    lid = lathe([(r - 0.004, h + 0.002), (r - 0.006, h + 0.008), (r * 0.8, h + 0.018), (0.018, h + 0.03)], segments)
    grip = lathe([(0.010, h + 0.028), (0.008, h + 0.04), (0.02, h + 0.048), (0.014, h + 0.058), (0.0, h + 0.06)], 10)
    model = Model((steel, body))
    top = Model((steel, lid), (p.BLACK, grip))
    if loops:
        for s in (1, -1):
            path = [
                (s * (r - 0.002), h * 0.78, -0.035),
                (s * (r + 0.03), h * 0.8, -0.03),
                (s * (r + 0.036), h * 0.8, 0.0),
                (s * (r + 0.03), h * 0.8, 0.03),
                (s * (r - 0.002), h * 0.78, 0.035),
            ]
            model.add(p.BLACK, tube(path, 0.006, 6, caps=(False, False), up=(0, 1, 0)))
    return model, top


def cookware(scene):
    at = lambda i: (CENTRE_X + BURNERS[i][0], GRATE_TOP - SINK, CENTRE_Z + BURNERS[i][1])
    body, lid = pot(0.11, 0.13, 18)
    scene.add("Stockpot", body, at=at(0), turn=[("y", 20)])
    scene.add("Stockpot lid", lid, at=at(0))
    body, lid = pot(0.105, 0.09, 18, p.RED_ENAMEL)
    scene.add("Casserole", body, at=at(3), turn=[("y", -15)])
    scene.add("Casserole lid", lid, at=at(3))
    kettle(scene, at(2))
    frying_pan(scene, at(1))


def frying_pan(scene, at):
    r, h = 0.11, 0.045
    pan = lathe(
        [
            (0.0, 0.0),
            (r - 0.025, 0.0),
            (r - 0.012, 0.008),
            (r, h),
            (r - 0.003, h + 0.002),
            (r - 0.016, 0.011),
            (r - 0.03, 0.006),
            (0.0, 0.006),
        ],
        18,
    )
    grip = tube(
        [(r - 0.008, h - 0.012, 0), (r + 0.05, h + 0.006, 0), (r + 0.12, h + 0.016, 0), (r + 0.19, h + 0.018, 0)],
        [0.008, 0.009, 0.011, 0.009],
        8,
        flatten=0.7,
        up=(0, 1, 0),
        caps=(False, True),
    )
    scene.add("Frying pan", Model((p.IRON, pan), (p.WOOD, grip)), at=at, turn=[("y", -28)])


def kettle(scene, at):
    body = lathe(
        [
            (0.0, 0.0),
            (0.088, 0.0),
            (0.095, 0.006),
            (0.097, 0.02),
            (0.092, 0.055),
            (0.078, 0.09),
            (0.058, 0.112),
            (0.038, 0.122),
        ],
        18,
    )
    lid = lathe([(0.039, 0.1215), (0.034, 0.127), (0.006, 0.134)], 12)
    grip = lathe([(0.005, 0.133), (0.006, 0.14), (0.012, 0.146), (0.011, 0.154), (0.0, 0.158)], 8)
    spout = tube(
        [(0.07, 0.055, 0), (0.10, 0.075, 0), (0.12, 0.105, 0), (0.138, 0.122, 0)],
        [0.021, 0.017, 0.013, 0.011],
        8,
        caps=(False, False),
        up=(0, 0, 1),
    )
    inside = tube([(0.138, 0.122, 0), (0.12, 0.105, 0)], [0.011, 0.011], 8, caps=(False, False), up=(0, 0, 1)).flipped()
    bow = [(-0.062, 0.10, 0)] + arc_points((0.0, 0.135, 0), 0.075, 170, 126, 3)
    handle = tube(bow, 0.0055, 6, caps=(False, False), up=(0, 0, 1))
    handle.extend(handle.mirrored("x"))
    hold = tube(arc_points((0.0, 0.135, 0), 0.075, 130, 50, 4), 0.010, 6, up=(0, 0, 1))
    model = Model((p.BLACK, inside)).add(p.CHROME, body, spout, lid, handle).add(p.RED, grip, hold)
    scene.add("Kettle", model, at=at, turn=[("y", -35)])
