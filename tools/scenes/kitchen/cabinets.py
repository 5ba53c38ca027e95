# SPDX-License-Identifier: Apache-2.0
"""Lower cabinets in an L, worktops, splashback of glazed tiles, upper cabinets."""

from modelling.shapes import polygon, quad
from modelling.surface import Model, Surface
from modelling.sweep import lathe, line, rectangle, sweep

from . import palette as p
from .kit import WORKTOP_DEPTH, WORKTOP_HEIGHT, bar_handle, facing, knob, panel_front, plain_front
from .room import RUN_END

FRONT = 0.58  # carcasses end here, fronts of 2 cm stand on them
PLINTH, CARCASS_TOP, GAP = 0.10, 0.86, 0.003
OVEN_X0, OVEN_X1 = 1.20, 1.80
BACK_END = 2.62  # of the back run; the fridge stands beyond
UPPER_Y0, UPPER_Y1, UPPER_DEPTH = 1.42, 2.14, 0.33
SINK_CENTRE_Z, SINK_HOLE = 1.35, (0.40, 0.50)  # along x, along z
TILE, TILE_GAP = (0.2, 0.1), 0.003


def build(scene):
    handle = bar_handle(0.14)
    with scene.group("Back run"):
        carcass(scene, "back", 0.60, BACK_END, ends=(False, True), posts=((0.60, 0.62), (2.60, BACK_END)))
        drawers(scene, "back", 0.62, 1.20, (0.30, 0.25, 0.19), handle)
        drawers(scene, "back right", 1.80, 2.20, (0.19,), handle)
        drawers(scene, "back far right", 2.20, 2.60, (0.19,), handle)
        doors(scene, "back right", (1.80, 2.20, 2.60), 0.19, handle)
    # Seen from its front the window run goes left to right from z = RUN_END to the corner.
    with scene.group("Window run", at=(0, 0, RUN_END), turn=[("y", 90)]):
        carcass(scene, "window", 0.0, RUN_END - 0.60, ends=(True, False), posts=((0.0, 0.02), (1.60, 1.62)))
        drawers(scene, "window", 0.02, 0.42, (0.30, 0.25, 0.19), handle)
        doors(scene, "sink", (0.42, 0.87, 1.32), 0.0, handle)
        doors(scene, "pull-out", (1.32, 1.60), 0.0, handle)
    worktops(scene)
    splashback(scene)
    uppers(scene)


def carcass(scene, name, x0, x1, ends, posts):
    """What shows in the gaps: the front of the boxes, their underside above the plinth, free ends; and the
    narrow posts that fill up the corners."""
    y0, y1, z = PLINTH, CARCASS_TOP, FRONT
    recess = z - 0.05
    box = quad((x0, y0, z), (x1 - x0, 0, 0), (0, y1 - y0, 0))
    box.extend(quad((x0, y0, recess), (x1 - x0, 0, 0), (0, 0, z - recess)))
    plinth = quad((x0, 0, recess), (x1 - x0, 0, 0), (0, y0, 0))
    side = Surface()
    if ends[0]:
        side.extend(quad((x0, y0, 0), (0, 0, z), (0, y1 - y0, 0)))
        plinth.extend(quad((x0, 0, 0), (0, 0, recess), (0, y0, 0)))
    if ends[1]:
        side.extend(quad((x1, y0, z), (0, 0, -z), (0, y1 - y0, 0)))
        plinth.extend(quad((x1, 0, recess), (0, 0, -recess), (0, y0, 0)))
    for a, b in posts:
        strip = plain_front(b - a - GAP / 2, y1 - y0)
        side.extend(strip.moved((a + b) / 2, (y0 + y1) / 2, FRONT))
    scene.add(f"Carcass {name}", Model((p.CARCASS, box), (p.PLINTH, plinth), (p.TEAL, side)))


def drawers(scene, name, x0, x1, heights, handle):
    """From the worktop down: the last height is the lowest drawer's if they fill the run."""
    top = CARCASS_TOP - 0.01
    filled = len(heights) > 1
    order = heights[::-1] if filled else heights
    width = x1 - x0 - GAP
    for i, height in enumerate(order):
        front = panel_front(width, height - GAP, frame=0.045) if height > 0.2 else plain_front(width, height - GAP)
        y = top - height / 2
        lift = 0.0 if height < 0.2 else min(height / 2 - 0.06, 0.085)
        model = Model((p.TEAL, front), (p.BRUSHED, handle.moved(0, lift, 0.02)))
        scene.add(f"Drawer {name} {i + 1}", model, at=((x0 + x1) / 2, y, FRONT))
        top -= height


def doors(scene, name, edges, from_top, handle):
    y0, y1 = PLINTH + 0.01, CARCASS_TOP - 0.01 - from_top
    pairs = list(zip(edges, edges[1:]))
    for i, (x0, x1) in enumerate(pairs):
        front = panel_front(x1 - x0 - GAP, y1 - y0 - GAP)
        hinge_left = len(pairs) > 1 and i == 0
        x = (x1 - x0) / 2 - 0.03
        grip = handle.turned(("z", 90)).moved(x if hinge_left else -x, (y1 - y0) / 2 - 0.13, 0.02)
        scene.add(
            f"Door {name} {i + 1}", Model((p.TEAL, front), (p.BRUSHED, grip)), at=((x0 + x1) / 2, (y0 + y1) / 2, FRONT)
        )


def worktop_profile(back):
    """(depth, height) from the underside behind the fronts, over the rounded edge, back along the top."""
    y0, y1, z, r = CARCASS_TOP, WORKTOP_HEIGHT, WORKTOP_DEPTH, 0.006
    return [
        (FRONT, y0),
        (z - r, y0),
        (z - 0.3 * r, y0 + 0.3 * r),
        (z, y0 + r),
        (z, y1 - r),
        (z - 0.3 * r, y1 - 0.3 * r),
        (z - r, y1),
        (back, y1),
    ]


def worktops(scene):
    end_of = lambda profile: [(z, y) for z, y in profile] + [(profile[-1][0], CARCASS_TOP)]
    back = worktop_profile(0.0)
    surface = sweep(line(0.0, BACK_END), back)
    surface.extend(polygon([(BACK_END, y, z) for z, y in reversed(end_of(back))]))
    scene.add("Worktop back", Model((p.WORKTOP, surface)))

    run = RUN_END + 0.02 - WORKTOP_DEPTH
    hole_x, hole_z = SINK_HOLE
    # Local x = RUN_END + 0.02 - z of the room; local z = x of the room.
    centre, middle = RUN_END + 0.02 - SINK_CENTRE_Z, 0.32
    inner = worktop_profile(0.0)
    front_edge = inner[:-1]
    window_run = sweep(line(0.0, run), front_edge)
    window_run.extend(polygon([(0.0, y, z) for z, y in end_of(inner)]))
    y = WORKTOP_HEIGHT
    outer = [(0.0, y, front_edge[-1][0]), (run, y, front_edge[-1][0]), (run, y, 0.0), (0.0, y, 0.0)]
    hole = [
        (centre - hole_z / 2, y, middle + hole_x / 2),
        (centre + hole_z / 2, y, middle + hole_x / 2),
        (centre + hole_z / 2, y, middle - hole_x / 2),
        (centre - hole_z / 2, y, middle - hole_x / 2),
    ]
    for i in range(4):
        k = (i + 1) % 4
        points = [outer[i], outer[k], hole[k], hole[i]]
        window_run.extend(polygon(points, [(q[0], q[2]) for q in points]))
    scene.add("Worktop window", Model((p.WORKTOP, window_run)), at=(0, 0, RUN_END + 0.02), turn=[("y", 90)])


def tiles(width, height):
    """Running bond of bevelled tiles on grout, from x = 0, y = 0, facing +z; only what shows of each tile."""
    step_x, step_y = TILE
    depth, bevel = 0.008, 0.006
    surface = Surface()
    rows = round(height / step_y)
    for row in range(rows):
        x = -step_x / 2 if row % 2 else 0.0
        while x < width - 1e-6:
            a, b = max(x, 0.0) + TILE_GAP / 2, min(x + step_x, width) - TILE_GAP / 2
            y0, y1 = row * step_y + TILE_GAP / 2, (row + 1) * step_y - TILE_GAP / 2
            outline = rectangle(b - a, y1 - y0)
            tile = facing(sweep(outline, [(0.0, 0.002), (-bevel, depth)], cap_end=True))
            surface.extend(tile.moved((a + b) / 2, (y0 + y1) / 2, 0))
            x += step_x
    grout = quad((0, 0, 0.0025), (width, 0, 0), (0, rows * step_y, 0))
    return surface, grout


def splashback(scene):
    surface, grout = tiles(BACK_END - 0.02, 0.5)
    scene.add("Splashback", Model((p.SPLASHBACK, surface), (p.GROUT, grout)), at=(0.01, WORKTOP_HEIGHT, 0))
    surface, grout = tiles(RUN_END - 0.02, 0.1)
    scene.add(
        "Splashback window",
        Model((p.SPLASHBACK, surface), (p.GROUT, grout)),
        at=(0, WORKTOP_HEIGHT, RUN_END - 0.01),
        turn=[("y", 90)],
    )


def upper_box(width, height, depth):
    """Open at the back and in front; the doors close it. Standing on its local y = 0, back at z = 0."""
    x = width / 2
    surface = quad((-x, 0, 0), (width, 0, 0), (0, 0, depth))
    surface.extend(quad((-x, height, depth), (width, 0, 0), (0, 0, -depth)))
    surface.extend(quad((-x, 0, 0), (0, 0, depth), (0, height, 0)))
    surface.extend(quad((x, 0, depth), (0, 0, -depth), (0, height, 0)))
    surface.extend(quad((-x, 0, depth), (width, 0, 0), (0, height, 0)))
    return surface


def uppers(scene):
    small_knob = knob(0.014, 0.026, 7)
    with scene.group("Upper cabinets"):
        basket = lathe(
            [
                (0.11, -0.0003),
                (0.125, 0.03),
                (0.14, 0.12),
                (0.147, 0.125),
                (0.144, 0.135),
                (0.134, 0.12),
                (0.12, 0.03),
                (0.0, 0.03),
            ],
            16,
        )
        scene.add("Basket", Model((p.WICKER, basket)), at=(2.05, UPPER_Y1, 0.16))
        for name, x0, x1, y0, y1, depth, count in (
            ("right", 1.82, 2.60, UPPER_Y0, UPPER_Y1, UPPER_DEPTH, 2),
            ("fridge", 2.62, 3.32, 1.86, UPPER_Y1, 0.50, 2),
        ):
            scene.add(
                f"Upper cabinet {name}",
                Model((p.LACQUER_WHITE, upper_box(x1 - x0, y1 - y0, depth))),
                at=((x0 + x1) / 2, y0, 0),
            )
            width = (x1 - x0) / count
            for i in range(count):
                x = x0 + (i + 0.5) * width
                front = panel_front(width - GAP, y1 - y0 - GAP)
                side = 1 if i == 0 else -1
                grip = small_knob.moved(side * (width / 2 - 0.03), 0.06 - (y1 - y0) / 2, 0.02)
                scene.add(
                    f"Upper door {name} {i + 1}",
                    Model((p.LACQUER_WHITE, front), (p.CHROME, grip)),
                    at=(x, (y0 + y1) / 2, depth + 0.001),
                )
