# SPDX-License-Identifier: Apache-2.0
"""Sink and tap under the window, and what stands around them."""

from modelling.shapes import bend, tube
from modelling.surface import Model
from modelling.sweep import lathe, rectangle, sweep

from . import palette as p
from .cabinets import SINK_CENTRE_Z, SINK_HOLE
from .kit import SINK, WORKTOP_HEIGHT as TOP
from .kit import arc_points


def build(scene):
    with scene.group("Sink", at=(0.32, TOP, SINK_CENTRE_Z)):
        x, z = SINK_HOLE
        rim = [
            (0.018, -SINK),
            (0.015, 0.004),
            (-0.012, 0.004),
            (-0.02, -0.002),
            (-0.026, -0.03),
            (-0.032, -0.145),
            (-0.05, -0.165),
        ]
        basin = sweep(rectangle(x, z, 0.06, 3), rim, cap_end=True)
        drain = lathe([(0.036, -0.1652), (0.033, -0.1615), (0.022, -0.1640), (0.0, -0.1640)], 12)
        scene.add("Sink", Model((p.STEEL, basin), (p.CHROME, drain)))
    tap(scene)
    washing_up(scene)


def tap(scene):
    with scene.group("Tap", at=(0.075, TOP, SINK_CENTRE_Z)):
        base = lathe([(0.027, -SINK), (0.027, 0.008), (0.02, 0.014), (0.02, 0.075), (0.016, 0.082), (0.0, 0.082)], 12)
        path = [(0, 0.08, 0)] + arc_points((0.095, 0.27, 0), 0.095, 180, 0, 8) + [(0.19, 0.235, 0)]
        spout = tube(path, 0.0115, 8, caps=(False, True), up=(0, 0, 1))
        lever = tube(
            [(0, 0.055, 0.018), (0.004, 0.06, 0.03), (0.012, 0.085, 0.05), (0.03, 0.125, 0.06)],
            [0.010, 0.010, 0.007, 0.0055],
            6,
            caps=(False, True),
            up=(1, 0, 0),
        )
        scene.add("Tap", Model().add(p.CHROME, base, spout, lever))


def washing_up(scene):
    soap = lathe([(0.03, -SINK), (0.032, 0.01), (0.032, 0.1), (0.026, 0.125), (0.011, 0.135), (0.011, 0.145)], 12)
    pump = lathe([(0.013, 0.145), (0.013, 0.16), (0.005, 0.162), (0.005, 0.185)], 7)
    nozzle = tube([(0, 0.18, -0.012), (0, 0.186, 0.01), (0, 0.18, 0.045)], [0.008, 0.007, 0.004], 5)
    scene.add(
        "Soap dispenser",
        Model((p.GREEN_GLAZE, soap), (p.CHROME, pump), (p.CHROME, nozzle)),
        at=(0.075, TOP, 1.62),
        turn=[("y", 60)],
    )
    sponge = sweep(rectangle(0.10, 0.065, 0.012, 2), [(-0.003, 0.0), (0.0, 0.004), (0.0, 0.028)])
    pad = sweep(rectangle(0.10, 0.065, 0.012, 2), [(0.0, 0.0), (0.0, 0.006), (-0.003, 0.009)], cap_end=True)
    scene.add(
        "Sponge",
        Model((p.YELLOW_MATTE, sponge), (p.GREEN, pad.moved(0, 0.028, 0))),
        at=(0.075, TOP - SINK, 1.08),
        turn=[("y", 82)],
    )
    board = sweep(
        rectangle(0.34, 0.40, 0.03, 2),
        [(0.0, -SINK), (0.0, 0.006), (-0.004, 0.010), (-0.012, 0.010), (-0.02, 0.005)],
        cap_end=True,
    )
    scene.add("Draining tray", Model((p.BRUSHED, board)), at=(0.33, TOP, 1.86))
    rack(scene)


def rack(scene):
    """Plates drying upright in a wire rack."""
    with scene.group("Plate rack", at=(0.33, TOP + 0.005, 1.86)):
        wire = 0.003
        model = Model()
        for x in (-0.10, 0.10):
            rail = bend([(x, 0.0, -0.15), (x, 0.05, -0.15), (x, 0.05, 0.15), (x, 0.0, 0.15)], 0.02, 2)
            model.add(p.CHROME, tube(rail, wire, 4, caps=(False, False), up=(1, 0, 0)))
        for k in range(6):
            z = -0.125 + 0.05 * k
            hoop = bend([(-0.10, 0.05, z), (-0.10, 0.012, z), (0.10, 0.012, z), (0.10, 0.05, z)], 0.012, 1)
            model.add(p.CHROME, tube(hoop, wire * 0.8, 3, caps=(False, False), up=(0, 0, 1)))
        scene.add("Plate rack", model)
        plate = lathe(
            [
                (0.0, -0.002),
                (0.055, -0.002),
                (0.075, 0.004),
                (0.105, 0.014),
                (0.107, 0.016),
                (0.104, 0.017),
                (0.072, 0.008),
                (0.055, 0.003),
                (0.0, 0.003),
            ],
            15,
        )
        white, blue = Model((p.PORCELAIN, plate)), Model((p.BLUE_GLAZE, plate))
        for k, model in enumerate((white, blue, white)):
            z = -0.085 + 0.05 * k
            scene.add(f"Drying plate {k + 1}", model, at=(0.0, 0.121, z), turn=[("x", 82)])
