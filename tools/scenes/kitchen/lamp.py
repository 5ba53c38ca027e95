# SPDX-License-Identifier: Apache-2.0
"""Pendant lamp over the table: the second light of the room."""

import math

from modelling.shapes import polygon, tube
from modelling.surface import Model
from modelling.sweep import lathe

from . import palette as p
from .kit import ROOM_HEIGHT
from .table import CENTRE

RIM, RADIUS = 1.76, 0.21  # height of the shade's rim


def build(scene):
    with scene.group("Pendant lamp", at=(CENTRE[0], 0, CENTRE[2])):
        y, r = RIM, RADIUS
        outer = lathe(
            [
                (r, y),
                (r * 0.985, y + 0.012),
                (r * 0.93, y + 0.06),
                (r * 0.78, y + 0.115),
                (r * 0.52, y + 0.155),
                (r * 0.24, y + 0.175),
                (0.03, y + 0.185),
                (0.028, y + 0.23),
                (0.008, y + 0.242),
            ],
            24,
        )
        inner = lathe(
            [
                (0.10, y + 0.134),
                (r * 0.77 - 0.003, y + 0.111),
                (r * 0.925 - 0.003, y + 0.058),
                (r * 0.98 - 0.004, y + 0.012),
                (r, y),
            ],
            24,
        )
        scene.add("Lamp shade", Model((p.ORANGE_LACQUER, outer), (p.WHITE_INSIDE, inner)))
        # An octagon of six triangles that faces down and closes the top of the inside.
        ring = [(0.1085 * math.cos(math.pi * k / 4), y + 0.1325, 0.1085 * math.sin(math.pi * k / 4)) for k in range(8)]
        scene.add("Lamp light", Model((p.LAMPLIGHT, polygon(ring))))
        scene.add(
            "Lamp cord",
            Model((p.BLACK, tube([(0, y + 0.24, 0), (0, ROOM_HEIGHT - 0.03, 0)], 0.004, 6, caps=(False, False)))),
        )
        rose = lathe([(0.006, -0.035), (0.035, -0.03), (0.05, -0.012), (0.052, 0.0)], 18)
        scene.add("Ceiling rose", Model((p.CHROME, rose)), at=(0, ROOM_HEIGHT, 0))
