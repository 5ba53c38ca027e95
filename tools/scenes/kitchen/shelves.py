# SPDX-License-Identifier: Apache-2.0
"""Two open shelves in the corner by the window: jars, spices, books, mugs on hooks."""

from modelling.shapes import bend, tube
from modelling.surface import Model
from modelling.sweep import lathe, slab

from . import palette as p
from . import vessels
from .kit import SINK

X0, X1, DEPTH, THICKNESS = 0.02, 0.78, 0.22, 0.025
LOWER, UPPER = 1.45, 1.84  # tops of the boards


def build(scene):
    board = Model((p.WOOD, slab(X1 - X0, DEPTH, THICKNESS, 0.003, bottom=True)))
    with scene.group("Corner shelves"):
        for name, top in (("lower", LOWER), ("upper", UPPER)):
            scene.add(f"Shelf {name}", board, at=((X0 + X1) / 2, top - THICKNESS, DEPTH / 2))
            for k, x in enumerate((0.16, 0.64)):
                path = bend([(0, -0.13, 0.0), (0, -0.02, DEPTH - 0.04), (0, -0.005, DEPTH - 0.03)], 0.012, 1)
                scene.add(f"Bracket {name} {k + 1}", Model((p.IRON, tube(path, 0.006, 5, up=(1, 0, 0)))), at=(x, top - THICKNESS, 0.0))
        lower_shelf(scene)
        upper_shelf(scene)
        mugs(scene)


def lower_shelf(scene):
    fillings = ((p.PASTA, 0.75), (p.COFFEE, 0.6), (p.RICE, 0.8), (p.BEANS, 0.5))
    for i, (filling, fill) in enumerate(fillings):
        scene.add(f"Jar {i + 1}", vessels.jar(filling, fill, height=0.16 - 0.012 * i), at=(0.10 + 0.115 * i, LOWER - SINK, 0.11))
    tins = (p.RED, p.YELLOW_MATTE, p.GREEN, p.ORANGE, p.BLUE)
    for i, paint in enumerate(tins):
        row, column = divmod(i, 3)
        scene.add(f"Spice tin {i + 1}", vessels.tin(paint), at=(0.57 + 0.063 * column + 0.03 * row, LOWER - SINK, 0.145 - 0.075 * row))


def upper_shelf(scene):
    books = ((p.RED, 0.032, 0.235), (p.CREAM, 0.024, 0.21), (p.BLUE, 0.038, 0.25), (p.YELLOW_MATTE, 0.022, 0.22), (p.GREEN, 0.030, 0.24),
             (p.PINK, 0.020, 0.20))
    x = 0.07
    for i, (cover, thick, height) in enumerate(books):
        scene.add(f"Book {i + 1}", book(cover, thick, height), at=(x + thick / 2, UPPER - SINK, 0.10))
        x += thick + 0.0015
    scene.add("Book end", Model((p.DARK_WOOD, slab(0.03, 0.12, 0.12, 0.004))), at=(x + 0.018, UPPER - SINK, 0.10))
    teapot(scene)
    tea = vessels.tin(p.TERRACOTTA, 0.05, 0.12, 16, p.BRASS)
    scene.add("Tea caddy", tea, at=(0.70, UPPER - SINK, 0.11))


def book(cover, thick, height):
    """Spine towards +z; paper shows on top between the covers."""
    depth, edge = 0.16, 0.003
    outside = slab(thick, depth, height, 0.002)
    inner = slab(thick - 2 * edge, depth - 2 * edge, 0.0012, 0.0003).moved(0, height - SINK, -edge / 2)
    return Model((cover, outside), (p.PAPER, inner))


def teapot(scene):
    body = lathe([(0.04, 0.0), (0.045, 0.006), (0.07, 0.03), (0.078, 0.06), (0.07, 0.09), (0.045, 0.112), (0.036, 0.116)], 20)
    lid = lathe([(0.038, 0.115), (0.034, 0.121), (0.015, 0.13), (0.006, 0.133), (0.008, 0.14), (0.012, 0.145), (0.009, 0.152), (0.0, 0.154)], 14)
    spout = tube([(0.06, 0.04, 0), (0.09, 0.055, 0), (0.105, 0.085, 0), (0.125, 0.112, 0)], [0.02, 0.014, 0.010, 0.008], 8,
                 caps=(False, False), up=(0, 0, 1))
    handle = tube([(-0.06, 0.095, 0), (-0.10, 0.10, 0), (-0.12, 0.075, 0), (-0.105, 0.045, 0), (-0.07, 0.032, 0)], 0.007, 7,
                  caps=(False, False), up=(0, 0, 1))
    with scene.group("Teapot", at=(0.47, UPPER - SINK, 0.11), turn=[("y", -20)]):
        scene.add("Teapot", Model((p.BLUE_GLAZE, body), (p.BLUE_GLAZE, spout), (p.BLUE_GLAZE, handle)))
        scene.add("Teapot lid", Model((p.BLUE_GLAZE, lid)))


def mugs(scene):
    """Under the lower shelf, each on a hook."""
    hook = Model((p.BRASS, tube(bend([(0, 0.001, 0), (0, -0.034, 0), (0, -0.034, 0.018), (0, -0.022, 0.02)], 0.006, 2), 0.002, 5,
                                caps=(False, True), up=(1, 0, 0))))
    glazes = (p.YELLOW, p.RED_ENAMEL, p.GREEN_GLAZE, p.BLUE_GLAZE)
    for i, glaze in enumerate(glazes):
        x = 0.13 + 0.145 * i + (0.03 if i > 1 else 0.0)
        y = LOWER - THICKNESS
        scene.add(f"Hook {i + 1}", hook, at=(x, y, 0.12))
        # The ear (at local x = 0.06) hangs in the hook: the mug is turned so that its ear is on top.
        scene.add(f"Mug {i + 1}", vessels.mug(glaze), at=(x - 0.045, y - 0.092, 0.128), turn=[("z", 75), ("y", 12 - 8 * i)])


