# SPDX-License-Identifier: Apache-2.0
"""Four spindle-back chairs, each in its own colour, with a cushion."""

import math

from modelling.shapes import tube
from modelling.surface import Model, Surface
from modelling.sweep import rectangle, slab, sweep

from . import palette as p
from .kit import arc_points, leg
from .table import CENTRE, PLACES

SEAT = 0.44  # top of the wooden seat; the cushion adds 3 cm


def chair(paint):
    """Faces -z (the table); its back is at +z."""
    seat = slab(0.42, 0.42, 0.03, 0.008, 0.07, 3, bottom=True).moved(0, SEAT - 0.03, 0)
    frame = Surface().extend(seat)
    feet = []
    for sx, sz in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        top, foot = (sx * 0.15, SEAT - 0.029, sz * 0.15), (sx * 0.20, 0.0, sz * 0.20)
        frame.extend(leg(top, foot, 0.017, 0.012, 6))
        feet.append([(a + (b - a) * 0.62) for a, b in zip(top, foot)])
    for a, b in ((0, 3), (1, 2)):
        frame.extend(tube([tuple(feet[a]), tuple(feet[b])], 0.008, 4, caps=(False, False)))
    middle = [tuple((u + v) / 2 for u, v in zip(feet[a], feet[b])) for a, b in ((0, 3), (1, 2))]
    frame.extend(tube(middle, 0.008, 4, caps=(False, False)))
    rail_y, bow = SEAT + 0.40, 0.30
    rail = [(x, y, z + 0.10) for x, y, z in arc_points((0.0, rail_y, -0.02), bow, 138, 42, 6, "xz")]
    frame.extend(tube(rail, [0.022, 0.035, 0.038, 0.038, 0.038, 0.035, 0.022], 8, flatten=0.32, up=(0.4, 0.0, 0.6)))
    for k in range(5):
        t = (k - 2) / 2
        x0, x1 = 0.14 * t, 0.185 * t
        z1 = 0.08 + math.sqrt(bow**2 - x1**2)
        frame.extend(
            tube(
                [(x0, SEAT - 0.006, 0.175 - 0.02 * t * t), (x1, rail_y, z1)],
                0.0085 if k in (0, 4) else 0.0065,
                4,
                caps=(False, False),
                up=(1, 0, 0),
            )
        )
    return Model((paint, frame))


def cushion(cloth):
    profile = [(-0.012, 0.0), (0.0, 0.010), (0.0, 0.018), (-0.012, 0.028), (-0.05, 0.033)]
    return Model((cloth, sweep(rectangle(0.37, 0.35, 0.06, 2), profile, cap_end=True, crease=75)))


def build(scene):
    paints = (p.CHAIR_BLUE, p.CHAIR_RED, p.CHAIR_YELLOW, p.CHAIR_GREEN)
    cloths = (p.CREAM, p.CREAM, p.CREAM, p.CREAM)
    # How far each is pulled out, sideways shift, twist.
    poses = ((0.10, 0.0, 4), (0.12, 0.02, -6), (0.14, -0.03, 6), (0.20, 0.04, -12))
    with scene.group("Chairs", at=CENTRE):
        for i, ((x, z, turn), (out, shift, twist)) in enumerate(zip(PLACES, poses)):
            sign = 1 if z > 0 else -1
            with scene.group(f"Seat {i + 1}", at=(x + shift, 0, z + sign * out), turn=[("y", turn + twist)]):
                scene.add(f"Chair {i + 1}", chair(paints[i]))
                scene.add(f"Cushion {i + 1}", cushion(cloths[i]), at=(0, SEAT - 0.0003, -0.005))
