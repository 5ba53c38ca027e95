# SPDX-License-Identifier: Apache-2.0
"""Two open shelves in the corner by the window: jars, spices, books, mugs on hooks."""

from modelling.shapes import bend, quad, tube
from modelling.surface import Model
from modelling.sweep import lathe, slab

from . import palette as p
from . import vessels
from .kit import SINK, bar_handle, facing, knob, plain_front

X0, X1, DEPTH, THICKNESS = 0.02, 1.12, 0.22, 0.025
LOWER, UPPER = 1.45, 1.84  # tops of the boards


def build(scene):
    board = Model((p.WOOD, slab(X1 - X0, DEPTH, THICKNESS, 0.003, bottom=True).moved(0, -THICKNESS, DEPTH / 2)))
    path = bend([(0, -0.13, 0.0), (0, -0.02, DEPTH - 0.04), (0, -0.005, DEPTH - 0.03)], 0.012, 1)
    for x in (-0.40, 0.40):
        board.add(p.IRON, tube(path, 0.006, 5, caps=(False, True), up=(1, 0, 0)).moved(x, -THICKNESS, 0))
    with scene.group("Corner shelves"):
        for name, top in (("lower", LOWER), ("upper", UPPER)):
            scene.add(f"Shelf {name}", board, at=((X0 + X1) / 2, top, 0))
        lower_shelf(scene)
        upper_shelf(scene)
        mugs(scene)


def lower_shelf(scene):
    fillings = ((p.PASTA, 0.75), (p.COFFEE, 0.6), (p.RICE, 0.8), (p.BEANS, 0.5))
    for i, (filling, fill) in enumerate(fillings):
        scene.add(
            f"Jar {i + 1}",
            vessels.jar(filling, fill, height=0.16 - 0.012 * i),
            at=(0.10 + 0.115 * i, LOWER - SINK, 0.11),
        )
    tins = (p.RED, p.YELLOW_MATTE, p.GREEN, p.ORANGE, p.BLUE)
    for i, paint in enumerate(tins):
        scene.add(f"Spice tin {i + 1}", vessels.tin(paint), at=(0.57 + 0.062 * i, LOWER - SINK, 0.13 - 0.02 * (i % 2)))
    radio(scene)


def upper_shelf(scene):
    books = (
        (p.RED, 0.032, 0.235),
        (p.CREAM, 0.024, 0.21),
        (p.BLUE, 0.038, 0.25),
        (p.YELLOW_MATTE, 0.022, 0.22),
        (p.GREEN, 0.030, 0.24),
        (p.PINK, 0.020, 0.20),
    )
    x = 0.09
    for i, (cover, thick, height) in enumerate(books):
        scene.add(f"Book {i + 1}", book(cover, thick, height), at=(x + thick / 2, UPPER - SINK, 0.10))
        x += thick + 0.0015
    scene.add("Book end", Model((p.DARK_WOOD, slab(0.03, 0.12, 0.12, 0.004))), at=(x + 0.018, UPPER - SINK, 0.10))
    teapot(scene)
    tea = vessels.tin(p.TERRACOTTA, 0.05, 0.12, 13, p.BRASS)
    scene.add("Tea caddy", tea, at=(0.66, UPPER - SINK, 0.11))
    jug = lathe(
        [
            (0.055, 0.0),
            (0.062, 0.01),
            (0.066, 0.06),
            (0.05, 0.13),
            (0.042, 0.16),
            (0.05, 0.19),
            (0.047, 0.19),
            (0.039, 0.16),
            (0.0, 0.13),
        ],
        12,
    )
    ear = tube(
        [(0.042, 0.175, 0), (0.08, 0.175, 0), (0.092, 0.13, 0), (0.066, 0.07, 0)],
        0.006,
        5,
        caps=(False, False),
        up=(0, 0, 1),
    )
    scene.add("Copper jug", Model().add(p.COPPER, jug, ear), at=(0.81, UPPER - SINK, 0.11), turn=[("y", -30)])
    scene.add("Salad bowl", Model((p.GREEN_GLAZE, vessels.bowl(0.095, 0.085, 15))), at=(0.98, UPPER - SINK, 0.11))


def radio(scene):
    """A small wireless with a loudspeaker, a dial and a carrying handle."""
    case = slab(0.20, 0.09, 0.13, 0.012, 0.02, 1)
    front = lambda surface, x, y: facing(surface).moved(x, y, 0.045)
    speaker = front(lathe([(0.045, -SINK), (0.043, 0.003), (0.038, 0.001), (0.0, 0.004)], 12), -0.04, 0.06)
    dials = knob(0.014, 0.012).moved(0.06, 0.04, 0.045)
    scale = plain_front(0.055, 0.035, 0.003, 0.001).moved(0.06, 0.085, 0.045 - SINK)
    grip = bar_handle(0.14, 0.03, 0.004, 5).turned(("x", -90)).moved(0, 0.13, 0)
    needle = quad((0.066, 0.073, 0.0485), (0.002, 0, 0), (0, 0.024, 0))
    model = Model((p.SKY_BLUE, case), (p.CREAM, speaker), (p.PAPER, scale), (p.RED, needle))
    model.add(p.CHROME, dials, grip)
    scene.add("Radio", model, at=(1.0, LOWER - SINK, 0.11), turn=[("y", 12)])


def book(cover, thick, height):
    """Spine towards +z; paper shows on top between the covers."""
    depth, edge = 0.16, 0.003
    outside = slab(thick, depth, height, 0.002)
    inner = slab(thick - 2 * edge, depth - 2 * edge, 0.0012, 0.0003).moved(0, height - SINK, -edge / 2)
    return Model((cover, outside), (p.PAPER, inner))


def teapot(scene):
    body = lathe([(0.042, 0.0), (0.07, 0.03), (0.078, 0.06), (0.07, 0.09), (0.036, 0.116)], 14)
    lid = lathe([(0.038, 0.115), (0.034, 0.121), (0.007, 0.133), (0.012, 0.145), (0.009, 0.152), (0.0, 0.154)], 9)
    spout = tube(
        [(0.06, 0.04, 0), (0.09, 0.055, 0), (0.105, 0.085, 0), (0.125, 0.112, 0)],
        [0.02, 0.014, 0.010, 0.008],
        7,
        caps=(False, False),
        up=(0, 0, 1),
    )
    handle = tube(
        [(-0.06, 0.095, 0), (-0.10, 0.10, 0), (-0.12, 0.075, 0), (-0.105, 0.045, 0), (-0.07, 0.032, 0)],
        0.007,
        5,
        caps=(False, False),
        up=(0, 0, 1),
    )
    with scene.group("Teapot", at=(0.47, UPPER - SINK, 0.11), turn=[("y", -25)]):
        model = Model()
        scene.add("Teapot", model.add(p.BLUE_GLAZE, body, spout, handle, lid))


def mugs(scene):
    """Under the lower shelf, each on a hook."""
    hook = tube(
        bend([(0, 0.001, 0), (0, -0.034, 0), (0, -0.034, 0.018), (0, -0.022, 0.02)], 0.006, 1),
        0.002,
        4,
        caps=(False, True),
        up=(1, 0, 0),
    )
    glazes = (p.YELLOW, p.RED_ENAMEL, p.GREEN_GLAZE, p.BLUE_GLAZE)
    for i, glaze in enumerate(glazes):
        model = Model((p.BRASS, hook))
        # The ear hangs in the hook: the mug is turned so that its ear is on top.
        for material, part in vessels.mug(glaze).parts.items():
            model.add(material, part.turned(("z", 75), ("y", 12 - 8 * i)).moved(-0.045, -0.092, 0.008))
        scene.add(f"Mug {i + 1}", model, at=(0.30 + 0.14 * i, LOWER - THICKNESS, 0.12))
