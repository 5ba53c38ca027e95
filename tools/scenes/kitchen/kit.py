# SPDX-License-Identifier: Apache-2.0
"""Parts that many pieces of furniture share, and the room's main measures in metres."""

import math

from modelling.shapes import bend, tube
from modelling.surface import Model
from modelling.sweep import lathe, rectangle, sweep

ROOM_WIDTH, ROOM_HEIGHT, ROOM_DEPTH = 4.6, 2.6, 4.0  # x, y, z; the window is in the wall x = 0
WORKTOP_HEIGHT, WORKTOP_DEPTH = 0.90, 0.62
TABLE_HEIGHT = 0.75
SINK = 0.0003  # what stands on a surface dips into it by this much: no gap for light to leak through


def facing(surface):
    """Turns what was swept upwards so that it faces +z: its x stays, its z points down."""
    return surface.turned(("x", 90))


def panel_front(width, height, thickness=0.02, frame=0.055):
    """A door with a recessed panel, centred, its back open at z = 0."""
    b = 0.002
    profile = [
        (0.0, 0.0),
        (0.0, thickness - b),
        (-b, thickness),
        (-frame, thickness),
        (-frame - 0.008, thickness - 0.009),
    ]
    return facing(sweep(rectangle(width, height), profile, cap_end=True))


def plain_front(width, height, thickness=0.02, bevel=0.002):
    return facing(
        sweep(rectangle(width, height), [(0.0, 0.0), (0.0, thickness - bevel), (-bevel, thickness)], cap_end=True)
    )


def bar_handle(length, reach=0.03, radius=0.005, sides=6, steps=1):
    """Along x, standing out of the plane z = 0."""
    h = length / 2
    path = bend([(-h, 0.0, -0.001), (-h, 0.0, reach), (h, 0.0, reach), (h, 0.0, -0.001)], 0.014, steps)
    return tube(path, radius, sides, caps=(False, False), up=(0.0, 1.0, 0.0))


def knob(radius, depth, segments=8):
    """Faces +z."""
    profile = [
        (radius * 0.45, -SINK),
        (radius * 0.45, depth * 0.4),
        (radius, depth * 0.55),
        (radius * 0.96, depth * 0.85),
        (radius * 0.6, depth),
        (0.0, depth),
    ]
    return facing(lathe(profile, segments))


def leg(top, foot, radius_top, radius_foot, sides=6):
    """Straight tapered leg, open at both ends."""
    return tube([top, foot], [radius_top, radius_foot], sides, caps=(False, False), up=(1.0, 0.0, 0.0))


def arc_points(centre, radius, start, end, steps, plane="xy"):
    """Points on an arc, degrees from the plane's first axis towards its second."""
    a, b = ("xyz".index(c) for c in plane)
    result = []
    for i in range(steps + 1):
        angle = math.radians(start + (end - start) * i / steps)
        p = list(centre)
        p[a] += radius * math.cos(angle)
        p[b] += radius * math.sin(angle)
        result.append(tuple(p))
    return result


def round_profile(radius, height, steps, bottom=0.0):
    """Quarter ellipse from (radius, bottom) to the axis at bottom + height."""
    return [
        (
            radius * math.cos(math.pi / 2 * i / steps) if i < steps else 0.0,
            bottom + height * math.sin(math.pi / 2 * i / steps),
        )
        for i in range(steps + 1)
    ]


__all__ = ["Model"]
