# SPDX-License-Identifier: Apache-2.0
"""Floor, walls, ceiling, mouldings, and the door behind the visitor."""

from modelling.shapes import polygon, quad, tube
from modelling.surface import Model, Surface
from modelling.sweep import lathe, polyline, rectangle, sweep

from . import palette as p
from .kit import ROOM_DEPTH as D
from .kit import ROOM_HEIGHT as H
from .kit import ROOM_WIDTH as W
from .kit import facing

# The window's niche in the wall x = 0.
NICHE_Z0, NICHE_Z1, NICHE_Y0, NICHE_Y1, NICHE_DEPTH = 0.62, 1.92, 1.05, 2.15, 0.20
SILL_TOP = 1.08
FRIDGE_END, RUN_END = 3.33, 2.22  # where the back and the left wall become free
DOOR_Z0, DOOR_Z1, DOOR_HEIGHT = 2.35, 3.25, 2.05  # in the wall x = W


def build(scene):
    with scene.group("Room"):
        scene.add("Floor", Model((p.FLOOR, quad((0, 0, D), (W, 0, 0), (0, 0, -D)))))
        scene.add("Ceiling", Model((p.CEILING, quad((0, H, 0), (W, 0, 0), (0, 0, D)))))
        scene.add("Back wall", Model((p.WALL_WHITE, quad((0, 0, 0), (W, 0, 0), (0, H, 0)))))
        scene.add("Front wall", Model((p.WALL_WHITE, quad((W, 0, D), (-W, 0, 0), (0, H, 0)))))
        scene.add("Right wall", Model((p.WALL_ORANGE, right_wall())))
        scene.add("Window wall", Model((p.WALL_GREEN, window_wall()), (p.WOODWORK, niche())))
        scene.add("Cornice", Model((p.CEILING, cornice())))
        skirting = [(0.016, 0.0), (0.016, 0.07), (0.007, 0.09), (0.0, 0.092)]
        scene.add(
            "Skirting by the fridge",
            Model((p.WOODWORK, sweep(polyline([(W, DOOR_Z0 - 0.06), (W, 0), (FRIDGE_END, 0)]), skirting))),
        )
        scene.add(
            "Skirting",
            Model((p.WOODWORK, sweep(polyline([(0, RUN_END), (0, D), (W, D), (W, DOOR_Z1 + 0.06)]), skirting))),
        )
        door(scene)


def window_wall():
    """The wall around the niche: four trapezia between two rectangles."""
    outer = [(0, 0, D), (0, 0, 0), (0, H, 0), (0, H, D)]
    inner = [(0, NICHE_Y0, NICHE_Z1), (0, NICHE_Y0, NICHE_Z0), (0, NICHE_Y1, NICHE_Z0), (0, NICHE_Y1, NICHE_Z1)]
    surface = Surface()
    for i in range(4):
        k = (i + 1) % 4
        surface.extend(polygon([outer[i], outer[k], inner[k], inner[i]]))
    return surface


def niche():
    """Its sides and top; the window board is its bottom."""
    d = -NICHE_DEPTH
    y0, y1, z0, z1 = SILL_TOP, NICHE_Y1, NICHE_Z0, NICHE_Z1
    surface = quad((d, y0, z0), (-d, 0, 0), (0, y1 - y0, 0))
    surface.extend(quad((0, y0, z1), (d, 0, 0), (0, y1 - y0, 0)))
    surface.extend(quad((d, y1, z0), (-d, 0, 0), (0, 0, z1 - z0)))
    return surface


def right_wall():
    """Leaves out what the door covers."""
    surface = quad((W, 0, 0), (0, 0, DOOR_Z0), (0, H, 0))
    surface.extend(quad((W, 0, DOOR_Z1), (0, 0, D - DOOR_Z1), (0, H, 0)))
    surface.extend(quad((W, DOOR_HEIGHT, DOOR_Z0), (0, 0, DOOR_Z1 - DOOR_Z0), (0, H - DOOR_HEIGHT, 0)))
    return surface


def cornice():
    hollow = [(0.0, H - 0.075), (0.012, H - 0.07), (0.02, H - 0.045), (0.045, H - 0.02), (0.07, H - 0.012), (0.075, H)]
    return sweep(polyline([(0, D), (W, D), (W, 0), (0, 0)], closed=True), hollow)


def door(scene):
    width, height = DOOR_Z1 - DOOR_Z0, DOOR_HEIGHT
    with scene.group("Door", at=(W, 0, (DOOR_Z0 + DOOR_Z1) / 2), turn=[("y", -90)]):
        trim = [(0.06, 0.0), (0.06, 0.012), (0.05, 0.018), (0.012, 0.018), (0.0, 0.008), (0.0, -0.03)]
        h = width / 2
        frame = facing(sweep(polyline([(-h, 0), (-h, -height), (h, -height), (h, 0)]), trim))
        scene.add("Door frame", Model((p.WOODWORK, frame)))
        # Two recessed panels; the frame's reveal closes the leaf's edges.
        panel = [(0.0, 0.0), (-0.11, 0.0), (-0.118, -0.009)]
        lower, upper = 0.95, height - 0.95
        leaf = facing(sweep(rectangle(width, lower), panel, cap_end=True)).moved(0, lower / 2, -0.03)
        leaf.extend(facing(sweep(rectangle(width, upper), panel, cap_end=True)).moved(0, lower + upper / 2, -0.03))
        rose = facing(lathe([(0.026, 0.0), (0.026, 0.006), (0.022, 0.009), (0.009, 0.01), (0.009, 0.05)], 8))
        lever = tube([(0, 0, 0.045), (-0.03, 0, 0.05), (-0.11, 0, 0.048)], [0.009, 0.009, 0.007], 8, up=(0, 1, 0))
        handle = rose.extend(lever).moved(h - 0.055, 1.02, -0.0302)
        scene.add("Door leaf", Model((p.LACQUER_WHITE, leaf), (p.CHROME, handle)))
