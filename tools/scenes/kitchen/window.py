# SPDX-License-Identifier: Apache-2.0
"""The window: frame, two casements, panes, board, curtain, and the daylight outside."""

import math

from modelling.shapes import polygon, quad, sheet, tube
from modelling.surface import Model
from modelling.sweep import lathe, line, rectangle, sweep

from . import palette as p
from .room import NICHE_DEPTH, NICHE_Y0, NICHE_Y1, NICHE_Z0, NICHE_Z1, SILL_TOP

WIDTH, HEIGHT = NICHE_Z1 - NICHE_Z0, NICHE_Y1 - SILL_TOP
FRAME = 0.045


def build(scene):
    # Local x runs along the wall (towards -z of the room), local z into the room.
    with scene.group("Window", at=(0, 0, (NICHE_Z0 + NICHE_Z1) / 2), turn=[("y", 90)]):
        centre = (SILL_TOP + NICHE_Y1) / 2
        upright = lambda surface: surface.turned(("x", 90))
        frame = [(0.0, 0.03), (-FRAME + 0.004, 0.03), (-FRAME, 0.026), (-FRAME, -0.03)]
        scene.add(
            "Window frame", Model((p.WOODWORK, upright(sweep(rectangle(WIDTH, HEIGHT), frame)))), at=(0, centre, -0.13)
        )
        w, h = (WIDTH - 2 * FRAME) / 2, HEIGHT - 2 * FRAME
        bar = 0.05
        casement = [(0.0, -0.02), (0.0, 0.016), (-0.004, 0.02), (-bar + 0.008, 0.02), (-bar, 0.008), (-bar, -0.02)]
        sash = upright(sweep(rectangle(w - 0.004, h - 0.004), casement))
        x, y = w / 2 - 0.002 - bar, h / 2 - 0.002 - bar
        pane = quad((-x, -y, -0.005), (2 * x, 0, 0), (0, 2 * y, 0))
        leaf = Model((p.WOODWORK, sash), (p.GLASS, pane))
        for side, x in (("left", -w / 2), ("right", w / 2)):
            scene.add(f"Casement {side}", leaf, at=(x, centre, -0.13))
        grip = lathe([(0.012, 0.0), (0.012, 0.006), (0.006, 0.008), (0.006, 0.03)], 8).turned(("x", 90))
        lever = tube([(0, 0.012, 0.03), (0, -0.02, 0.032), (0, -0.09, 0.036)], [0.009, 0.008, 0.006], 6, up=(0, 0, 1))
        scene.add("Window handle", Model((p.CHROME, grip), (p.CHROME, lever)), at=(0.025, centre - 0.05, -0.1105))
        board(scene)
        scene.add(
            "Daylight", Model((p.DAYLIGHT, quad((-WIDTH / 2, SILL_TOP, -NICHE_DEPTH), (WIDTH, 0, 0), (0, HEIGHT, 0))))
        )
        curtains(scene)


def board(scene):
    profile = [
        (0.0, NICHE_Y0),
        (0.03, NICHE_Y0),
        (0.035, NICHE_Y0 + 0.005),
        (0.035, SILL_TOP - 0.005),
        (0.03, SILL_TOP),
        (-NICHE_DEPTH, SILL_TOP),
    ]
    surface = sweep(line(-WIDTH / 2, WIDTH / 2), profile)
    end = [(y, z) for z, y in profile[:5]] + [(SILL_TOP, 0.0)]
    surface.extend(polygon([(-WIDTH / 2, y, z) for y, z in end]))
    surface.extend(polygon([(WIDTH / 2, y, z) for y, z in reversed(end)]))
    scene.add("Window board", Model((p.WOODWORK, surface)))


def curtains(scene):
    """Two narrow curtains on a rod."""
    rod_y, reach = NICHE_Y1 + 0.09, 0.06
    half = WIDTH / 2 + 0.16
    rod = tube([(-half, rod_y, reach), (half, rod_y, reach)], 0.009, 8, caps=(False, False))
    ball = lathe([(0.0, -0.018), (0.013, -0.013), (0.018, 0.0), (0.013, 0.013), (0.0, 0.018)], 8)
    scene.add(
        "Curtain rod", Model().add(p.CHROME, rod, ball.moved(-half, rod_y, reach), ball.moved(half, rod_y, reach))
    )

    def cloth(s, t):
        """Folds that widen a little towards the hem."""
        width = 0.23
        fold = 0.022 * (0.75 + 0.25 * (1 - t))
        return (width * (s - 0.5), 0.98 + t * (rod_y - 0.012 - 0.98), reach + fold * math.sin(2 * math.pi * 3.5 * s))

    model = Model((p.CURTAIN, sheet(cloth, 28, 2)))
    for side, x in (("left", -half + 0.15), ("right", half - 0.15)):
        scene.add(f"Curtain {side}", model, at=(x, 0, 0))
