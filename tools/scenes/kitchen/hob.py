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
        tray = sweep(rectangle(0.58, 0.50, 0.02, 2), [(0.0, -SINK), (0.0, 0.004), (-0.004, 0.008), (-0.018, 0.008), (-0.024, 0.005)],
                     cap_end=True)
        scene.add("Hob", Model((p.BRUSHED, tray)))
        burner = lathe([(0.045, 0.0), (0.043, 0.008), (0.032, 0.010), (0.032, 0.016), (0.029, 0.019), (0.0, 0.020)], 16)
        model = Model((p.IRON, burner))
        for i, (x, z) in enumerate(BURNERS):
            scene.add(f"Burner {i + 1}", model, at=(x, 0.005 - SINK, z))
        for side, x in (("left", -0.145), ("right", 0.145)):
            scene.add(f"Pan support {side}", Model((p.IRON, grate())), at=(x, 0.0, 0.0))


def grate():
    """Square bars on four feet; their top is at GRATE_TOP."""
    y, r = GRATE_TOP - TOP - 0.005, 0.005 * math.sqrt(2)
    turned = lambda a, b: tube([a, b], r, 4, up=(0.0, 1.0, 1.0) if a[2] == b[2] else (1.0, 1.0, 0.0))
    surface = Surface()
    for x in (-0.125, 0.0, 0.125):
        surface.extend(turned((x, y, -0.225), (x, y, 0.225)))
    for z in (-0.22, -0.12, 0.12, 0.22):
        surface.extend(turned((-0.12, y, z), (0.12, y, z)))
    for x in (-0.125, 0.125):
        for z in (-0.21, 0.21):
            surface.extend(tube([(x, y, z), (x, 0.0046, z)], 0.006, 5, caps=(False, False), up=(1.0, 0.0, 0.0)))
    return surface


def oven(scene):
    x0, x1 = OVEN_X0 + 0.002, OVEN_X1 - 0.002
    width, top, bottom, panel = x1 - x0, CARCASS_TOP - 0.004, PLINTH + 0.01, 0.11
    with scene.group("Oven", at=((x0 + x1) / 2, 0, FRONT)):
        scene.add("Oven panel", Model((p.BRUSHED, plain_front(width, panel, 0.025))), at=(0, top - panel / 2, 0))
        display = plain_front(0.12, 0.04, 0.003, 0.001)
        scene.add("Oven display", Model((p.BLACK_GLASS, display)), at=(0, top - panel / 2, 0.025 - SINK))
        dial = Model((p.CHROME, knob(0.021, 0.028, 14)))
        for i, x in enumerate((-0.24, -0.16, 0.16, 0.24)):
            scene.add(f"Oven dial {i + 1}", dial, at=(x, top - panel / 2, 0.025))
        height = top - panel - 0.004 - bottom
        frame = facing(sweep(rectangle(width, height), [(0.0, 0.0), (0.0, 0.022), (-0.003, 0.025), (-0.055, 0.025), (-0.058, 0.0215)]))
        inside = quad((-width / 2 + 0.058, -height / 2 + 0.058, 0.0215), (width - 0.116, 0, 0), (0, height - 0.116, 0))
        scene.add("Oven door", Model((p.BRUSHED, frame), (p.BLACK_GLASS, inside)), at=(0, bottom + height / 2, 0))
        handle = Model((p.CHROME, bar_handle(0.48, 0.045, 0.009, 8)))
        scene.add("Oven handle", handle, at=(0, bottom + height - 0.03, 0.025))
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

    # Rows are spent on the fold: t runs over equal pieces, so the cloth is cut where it bends.
    rows = 24
    return sheet(cloth, 8, rows, uv=lambda s, t: (width * s, total * t))


def hood(scene):
    """Pyramid with a chimney up to the ceiling; its back is the wall."""
    bottom, rim, neck = 1.56, 0.05, 1.86
    h, d, hn, dn = 0.30, 0.50, 0.12, 0.24
    rings = [[(-h, bottom, 0), (-h, bottom, d), (h, bottom, d), (h, bottom, 0)],
             [(-h, bottom + rim, 0), (-h, bottom + rim, d), (h, bottom + rim, d), (h, bottom + rim, 0)],
             [(-hn, neck, 0), (-hn, neck, dn), (hn, neck, dn), (hn, neck, 0)],
             [(-hn, ROOM_HEIGHT - 0.0, 0), (-hn, ROOM_HEIGHT, dn), (hn, ROOM_HEIGHT, dn), (hn, ROOM_HEIGHT, 0)]]
    with scene.group("Extractor hood", at=(CENTRE_X, 0, 0)):
        for name, low, high in (("Hood rim", 0, 1), ("Hood", 1, 2), ("Chimney", 2, 3)):
            surface = Surface()
            for i in range(3):
                surface.extend(polygon([rings[low][i], rings[low][i + 1], rings[high][i + 1], rings[high][i]]))
            if low == 0:
                surface.extend(underside(h, d, bottom))
            scene.add(name, Model((p.STEEL, surface)))
        button = Model((p.BLACK, knob(0.008, 0.006, 8)))
        for i in range(3):
            scene.add(f"Hood button {i + 1}", button, at=(0.18 + 0.03 * i, bottom + rim / 2, d))


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
    body = lathe([(r - 0.008, 0.0), (r - 0.002, 0.003), (r, 0.012), (r, h - 0.004), (r + 0.005, h), (r + 0.005, h + 0.003), (r - 0.004, h + 0.004)],
                 segments)
    lid = lathe([(r - 0.004, h + 0.002), (r - 0.006, h + 0.008), (r * 0.85, h + 0.016), (r * 0.45, h + 0.027), (0.018, h + 0.03)], segments)
    grip = lathe([(0.010, h + 0.028), (0.008, h + 0.04), (0.02, h + 0.048), (0.02, h + 0.054), (0.012, h + 0.06), (0.0, h + 0.06)], 12)
    model = Model((steel, body))
    top = Model((steel, lid), (p.BLACK, grip))
    if loops:
        for s in (1, -1):
            path = [(s * (r - 0.002), h * 0.78, -0.035), (s * (r + 0.03), h * 0.8, -0.03), (s * (r + 0.036), h * 0.8, 0.0),
                    (s * (r + 0.03), h * 0.8, 0.03), (s * (r - 0.002), h * 0.78, 0.035)]
            model.add(p.BLACK, tube(path, 0.006, 6, caps=(False, False), up=(0, 1, 0)))
    return model, top


def cookware(scene):
    at = lambda i: (CENTRE_X + BURNERS[i][0], GRATE_TOP - SINK, CENTRE_Z + BURNERS[i][1])
    body, lid = pot(0.11, 0.13, 24)
    scene.add("Stockpot", body, at=at(0), turn=[("y", 20)])
    scene.add("Stockpot lid", lid, at=at(0))
    body, lid = pot(0.105, 0.09, 24, p.RED_ENAMEL)
    scene.add("Casserole", body, at=at(3), turn=[("y", -15)])
    scene.add("Casserole lid", lid, at=at(3))
    kettle(scene, at(2))
    frying_pan(scene, at(1))


def frying_pan(scene, at):
    r, h = 0.11, 0.045
    pan = lathe([(r - 0.025, 0.0), (r - 0.012, 0.008), (r, h), (r - 0.003, h + 0.002), (r - 0.016, 0.011), (r - 0.03, 0.006), (0.0, 0.006)], 24)
    grip = tube([(r - 0.008, h - 0.012, 0), (r + 0.05, h + 0.006, 0), (r + 0.12, h + 0.016, 0), (r + 0.19, h + 0.018, 0)],
                [0.008, 0.009, 0.011, 0.009], 8, flatten=0.7, up=(0, 1, 0), caps=(False, True))
    scene.add("Frying pan", Model((p.IRON, pan), (p.WOOD, grip)), at=at, turn=[("y", -28)])


def kettle(scene, at):
    body = lathe([(0.088, 0.0), (0.095, 0.006), (0.097, 0.02), (0.092, 0.055), (0.078, 0.09), (0.058, 0.112), (0.04, 0.121), (0.036, 0.123)], 24)
    lid = lathe([(0.038, 0.122), (0.034, 0.127), (0.02, 0.133), (0.006, 0.134)], 16)
    grip = lathe([(0.005, 0.133), (0.006, 0.14), (0.012, 0.146), (0.011, 0.154), (0.0, 0.158)], 10)
    spout = tube([(0.07, 0.055, 0), (0.10, 0.075, 0), (0.12, 0.105, 0), (0.138, 0.122, 0)], [0.021, 0.017, 0.013, 0.011], 10,
                 caps=(False, False), up=(0, 0, 1))
    inside = tube([(0.138, 0.122, 0), (0.12, 0.105, 0)], [0.011, 0.011], 10, caps=(False, False), up=(0, 0, 1)).flipped()
    arch = [(-0.062, 0.10, 0)] + arc_points((0.0, 0.135, 0), 0.075, 170, 10, 10) + [(0.062, 0.10, 0)]
    handle = tube(arch, 0.0055, 6, caps=(False, False), up=(0, 0, 1))
    hold = tube(arc_points((0.0, 0.135, 0), 0.075, 130, 50, 4), 0.010, 8, up=(0, 0, 1))
    scene.add("Kettle", Model((p.CHROME, body), (p.CHROME, spout), (p.BLACK, inside)), at=at, turn=[("y", -35)])
    scene.add("Kettle lid", Model((p.CHROME, lid), (p.RED, grip)), at=at)
    scene.add("Kettle handle", Model((p.CHROME, handle), (p.RED, hold)), at=at, turn=[("y", -35)])


