# SPDX-License-Identifier: Apache-2.0
"""Fridge with what is on it, toaster, mixer."""


from modelling.shapes import bend, quad, tube
from modelling.surface import Model
from modelling.sweep import lathe, rectangle, slab, sweep

from . import palette as p
from .kit import SINK, facing, knob, plain_front
from .kit import WORKTOP_HEIGHT as TOP

FRIDGE_X, FRIDGE_WIDTH, FRIDGE_HEIGHT = 2.97, 0.66, 1.74


def build(scene):
    fridge(scene)
    toaster(scene)
    mixer(scene)


def fridge_door(height):
    """Rounded like in the fifties: the face bulges."""
    outline = rectangle(FRIDGE_WIDTH, height, 0.05, 4)
    return facing(sweep(outline, [(0.0, 0.0), (0.0, 0.025), (-0.008, 0.043), (-0.024, 0.054), (-0.05, 0.058)], cap_end=True))


def fridge(scene):
    foot, split, depth = 0.06, 1.22, 0.60
    with scene.group("Fridge", at=(FRIDGE_X, 0, 0)):
        w, h = FRIDGE_WIDTH, FRIDGE_HEIGHT - foot
        shell = facing(sweep(rectangle(w - 0.004, h, 0.045, 3), [(0.0, 0.02), (0.0, depth - 0.008), (-0.01, depth - 0.008), (-0.05, depth - 0.008)],
                             cap_end=True))
        scene.add("Fridge", Model((p.RED_ENAMEL, shell)), at=(0, foot + h / 2, 0))
        base = sweep(rectangle(w - 0.08, depth - 0.12), [(0.0, 0.0), (0.0, foot + 0.01)])
        scene.add("Fridge base", Model((p.BLACK, base)), at=(0, 0, depth / 2))
        low, high = split - foot, FRIDGE_HEIGHT - split - 0.006
        scene.add("Fridge door", Model((p.RED_ENAMEL, fridge_door(low))), at=(0, foot + low / 2, depth))
        scene.add("Freezer door", Model((p.RED_ENAMEL, fridge_door(high))), at=(0, split + 0.006 + high / 2, depth))
        for name, y, length in (("Fridge handle", split - 0.22, 0.30), ("Freezer handle", split + 0.20, 0.22)):
            path = bend([(0, -length / 2, -0.002), (0, -length / 2, 0.05), (0, length / 2, 0.05), (0, length / 2, -0.002)], 0.03, 3)
            bar = tube(path, 0.011, 8, caps=(False, False), flatten=1.3, up=(1, 0, 0))
            scene.add(name, Model((p.CHROME, bar)), at=(-w / 2 + 0.075, y, depth + 0.0575))
        badge = plain_front(0.16, 0.022, 0.004, 0.0015)
        scene.add("Fridge badge", Model((p.CHROME, badge)), at=(0.17, FRIDGE_HEIGHT - 0.12, depth + 0.058 - SINK))
        notes = ((p.PAPER, 0.13, 0.16, 0.06, 1.02, 3), (p.YELLOW_MATTE, 0.075, 0.075, 0.20, 1.06, -5), (p.SKY_BLUE, 0.075, 0.075, -0.07, 0.93, 4))
        for i, (paper, nw, nh, x, y, tilt) in enumerate(notes):
            sheet = quad((-nw / 2, -nh / 2, 0.0012), (nw, 0, 0), (0, nh, 0))
            scene.add(f"Note {i + 1}", Model((paper, sheet)), at=(x, y, depth + 0.058), turn=[("z", tilt)])
            magnet = Model(((p.GREEN, p.BLUE, p.ORANGE)[i], knob(0.012, 0.012, 9)))
            scene.add(f"Magnet {i + 1}", magnet, at=(x, y + nh / 2 - 0.012, depth + 0.059))


def toaster(scene):
    """Chrome, with two slots and bread in them."""
    profile = [(0.004, -SINK), (0.004, 0.03), (0.0, 0.05), (0.0, 0.13), (-0.008, 0.155), (-0.028, 0.17), (-0.04, 0.172)]
    body = sweep(rectangle(0.29, 0.17, 0.045, 4), profile, cap_end=True)
    foot = sweep(rectangle(0.27, 0.15, 0.04, 2), [(0.0, -SINK), (0.0, 0.012)])
    lever = slab(0.022, 0.045, 0.016, 0.003, bottom=True).moved(0.152, 0.11, 0)
    dial = knob(0.016, 0.018, 10).turned(("y", 90)).moved(0.1448, 0.05, 0.035)
    with scene.group("Toaster", at=(0.27, TOP + 0.0, 0.30), turn=[("y", 45)]):
        scene.add("Toaster", Model((p.CHROME, body.moved(0, 0.01, 0)), (p.BLACK, foot), (p.BLACK, lever), (p.BLACK, dial)))
        toast = facing(sweep(rectangle(0.12, 0.10, 0.03, 2), [(-0.003, -0.007), (0.0, -0.004), (0.0, 0.004), (-0.003, 0.007)],
                             cap_start=True, cap_end=True))
        for i, z in enumerate((-0.028, 0.028)):
            slot = sweep(rectangle(0.15, 0.026), [(0.0, 0.1815), (0.0, 0.1845), (-0.004, 0.1845), (-0.006, 0.1825)], cap_end=True)
            scene.add(f"Toaster slot {i + 1}", Model((p.BLACK, slot)), at=(0, 0, z))
            if i == 0:
                scene.add("Toast", Model((p.CRUST, toast)), at=(0, 0.188, z))


def mixer(scene):
    """Stand mixer with its bowl, on the worktop by the fridge."""
    with scene.group("Mixer", at=(2.42, TOP, 0.25), turn=[("y", -60)]):
        foot = sweep(rectangle(0.30, 0.19, 0.06, 3), [(0.0, -SINK), (0.0, 0.015), (-0.012, 0.032), (-0.03, 0.036)], cap_end=True)
        stem = tube([(-0.10, 0.03, 0), (-0.105, 0.11, 0), (-0.10, 0.20, 0)], [0.062, 0.046, 0.058], 12, caps=(False, False),
                    flatten=0.8, up=(0, 0, 1))
        head_path = [(-0.17, 0.245, 0), (-0.155, 0.25, 0), (-0.11, 0.26, 0), (0.0, 0.265, 0), (0.10, 0.262, 0), (0.135, 0.258, 0), (0.145, 0.257, 0)]
        head = tube(head_path, [0.02, 0.05, 0.068, 0.07, 0.06, 0.042, 0.02], 14, up=(0, 1, 0), flatten=0.95)
        hub = lathe([(0.016, 0.0), (0.022, 0.06)], 10).moved(0.075, 0.14, 0)
        scene.add("Mixer", Model((p.YELLOW, foot), (p.YELLOW, stem), (p.YELLOW, head), (p.CHROME, hub)))
        bowl = lathe([(0.045, 0.0), (0.05, 0.012), (0.075, 0.05), (0.092, 0.10), (0.095, 0.125), (0.098, 0.126), (0.096, 0.129), (0.091, 0.126), (0.086, 0.10),
                      (0.07, 0.055), (0.045, 0.022), (0.0, 0.018)], 22)
        scene.add("Mixer bowl", Model((p.STEEL, bowl)), at=(0.06, 0.0358, 0))
        scene.add("Mixer switch", Model((p.CHROME, knob(0.014, 0.018, 10))), at=(-0.06, 0.26, 0.0645))


