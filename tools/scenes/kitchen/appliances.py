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
    bin_(scene)


def fridge_door(height):
    """Rounded like in the fifties: the face bulges."""
    outline = rectangle(FRIDGE_WIDTH, height, 0.05, 3)
    return facing(
        sweep(
            outline, [(-0.002, -0.0085), (0.0, 0.025), (-0.008, 0.043), (-0.024, 0.054), (-0.05, 0.058)], cap_end=True
        )
    )


def fridge(scene):
    foot, split, depth = 0.06, 1.22, 0.60
    with scene.group("Fridge", at=(FRIDGE_X, 0, 0)):
        w, h = FRIDGE_WIDTH, FRIDGE_HEIGHT - foot
        shell = facing(sweep(rectangle(w - 0.004, h, 0.045, 3), [(0.0, 0.02), (0.0, depth - 0.008)], cap_end=True))
        base = sweep(rectangle(w - 0.08, depth - 0.12), [(0.0, 0.0), (0.0, foot + 0.01)]).moved(
            0, -foot - h / 2, depth / 2
        )
        scene.add("Fridge", Model((p.RED_ENAMEL, shell), (p.BLACK, base)), at=(0, foot + h / 2, 0))
        low, high = split - foot, FRIDGE_HEIGHT - split - 0.006
        badge = plain_front(0.16, 0.022, 0.004, 0.0015)
        for name, y, height, grip, length in (
            ("Fridge door", foot + low / 2, low, low / 2 - 0.22, 0.30),
            ("Freezer door", split + 0.006 + high / 2, high, -0.06, 0.22),
        ):
            path = bend(
                [(0, -length / 2, -0.002), (0, -length / 2, 0.05), (0, length / 2, 0.05), (0, length / 2, -0.002)],
                0.03,
                3,
            )
            bar = tube(path, 0.011, 8, caps=(False, False), flatten=1.3, up=(1, 0, 0))
            door = Model((p.RED_ENAMEL, fridge_door(height)), (p.CHROME, bar.moved(-w / 2 + 0.075, grip, 0.0575)))
            if name == "Freezer door":
                door.add(p.CHROME, badge.moved(0.17, height / 2 - 0.12, 0.058 - SINK))
            scene.add(name, door, at=(0, y, depth))
        notes = (
            (p.PAPER, 0.13, 0.16, 0.06, 1.02, 3),
            (p.YELLOW_MATTE, 0.075, 0.075, 0.20, 1.06, -5),
            (p.SKY_BLUE, 0.075, 0.075, -0.07, 0.93, 4),
        )
        for i, (paper, nw, nh, x, y, tilt) in enumerate(notes):
            sheet = quad((-nw / 2, -nh / 2, 0.0012), (nw, 0, 0), (0, nh, 0))
            magnet = knob(0.012, 0.012, 7).moved(0, nh / 2 - 0.015, 0.0012)
            note = Model((paper, sheet), ((p.GREEN, p.BLUE, p.ORANGE)[i], magnet))
            scene.add(f"Note {i + 1}", note, at=(x, y, depth + 0.058), turn=[("z", tilt)])


def toaster(scene):
    """Chrome, with two slots and bread in them."""
    profile = [(-0.015, 0.0), (0.0, 0.0), (0.004, 0.03), (0.0, 0.05), (0.0, 0.13), (-0.010, 0.158), (-0.036, 0.172)]
    body = sweep(rectangle(0.29, 0.17, 0.045, 3), profile, cap_end=True)
    foot = sweep(rectangle(0.27, 0.15, 0.035, 3), [(0.0, -SINK), (0.0, 0.012)])
    lever = slab(0.022, 0.045, 0.016, 0.003, bottom=True).moved(0.152, 0.11, 0)
    dial = knob(0.016, 0.018, 10).turned(("y", 90)).moved(0.1448, 0.05, 0.035)
    with scene.group("Toaster", at=(0.27, TOP + 0.0, 0.30), turn=[("y", 45)]):
        model = Model((p.CHROME, body.moved(0, 0.01, 0))).add(p.BLACK, foot, lever, dial)
        toast = facing(
            sweep(
                rectangle(0.12, 0.10, 0.03, 2),
                [(-0.003, -0.007), (0.0, -0.004), (0.0, 0.004), (-0.003, 0.007)],
                cap_start=True,
                cap_end=True,
            )
        )
        for z in (-0.028, 0.028):
            slot = sweep(
                rectangle(0.15, 0.026), [(0.0, 0.1815), (0.0, 0.1845), (-0.004, 0.1845), (-0.006, 0.1825)], cap_end=True
            )
            model.add(p.BLACK, slot.moved(0, 0, z))
        scene.add("Toaster", model)
        scene.add("Toast", Model((p.CRUST, toast)), at=(0, 0.188, -0.028))


def mixer(scene):
    """Stand mixer with its bowl, on the worktop by the fridge."""
    with scene.group("Mixer", at=(2.42, TOP, 0.25), turn=[("y", -60)]):
        foot = sweep(
            rectangle(0.30, 0.19, 0.06, 2), [(0.0, -SINK), (0.0, 0.015), (-0.012, 0.032), (-0.03, 0.036)], cap_end=True
        )
        stem = tube(
            [(-0.10, 0.03, 0), (-0.105, 0.11, 0), (-0.10, 0.20, 0)],
            [0.062, 0.046, 0.058],
            10,
            caps=(False, False),
            flatten=0.8,
            up=(0, 0, 1),
        )
        head_path = [
            (-0.17, 0.245, 0),
            (-0.155, 0.25, 0),
            (-0.11, 0.26, 0),
            (0.0, 0.265, 0),
            (0.10, 0.262, 0),
            (0.135, 0.258, 0),
            (0.145, 0.257, 0),
        ]
        head = tube(head_path, [0.02, 0.05, 0.068, 0.07, 0.06, 0.042, 0.02], 11, up=(0, 1, 0), flatten=0.95)
        hub = lathe([(0.016, 0.0), (0.022, 0.06)], 8).moved(0.075, 0.14, 0)
        switch = knob(0.014, 0.018).moved(-0.06, 0.26, 0.0645)
        scene.add("Mixer", Model().add(p.YELLOW, foot, stem, head).add(p.CHROME, hub, switch))
        bowl = lathe(
            [
                (0.045, 0.0),
                (0.05, 0.012),
                (0.075, 0.05),
                (0.092, 0.10),
                (0.095, 0.127),
                (0.096, 0.130),
                (0.091, 0.127),
                (0.086, 0.10),
                (0.066, 0.05),
                (0.0, 0.018),
            ],
            16,
        )
        scene.add("Mixer bowl", Model((p.STEEL, bowl)), at=(0.06, 0.0358, 0))


def bin_(scene):
    """Pedal bin beside the fridge."""
    r, h = 0.13, 0.40
    foot = lathe([(r - 0.004, 0.0), (r + 0.003, 0.004), (r + 0.003, 0.03), (r, 0.032)], 17)
    body = lathe([(r, 0.032), (r, h), (r + 0.004, h + 0.002), (r + 0.004, h + 0.02)], 17)
    lid = lathe([(r + 0.004, h + 0.02), (r * 0.93, h + 0.045), (r * 0.6, h + 0.065), (0.0, h + 0.07)], 17)
    pedal = slab(0.05, 0.05, 0.012, 0.004, bottom=True).moved(0, 0.012, r + 0.015)
    model = Model((p.BLACK, foot), (p.YELLOW, body), (p.CHROME, lid)).add(p.BLACK, pedal)
    scene.add("Pedal bin", model, at=(3.56, 0, 0.26), turn=[("y", 25)])
