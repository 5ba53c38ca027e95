# SPDX-License-Identifier: Apache-2.0
"""Clock, poster, mirror, towel rail, socket, switch."""

from modelling.shapes import polygon
from modelling.surface import Model, Surface
from modelling.sweep import circle, lathe, rectangle, sweep

from . import palette as p
from .kit import ROOM_WIDTH, SINK, facing, plain_front


def build(scene):
    # On the window wall x = 0: local x runs towards -z, local z into the room.
    with scene.group("On the window wall", at=(0, 0, 2.28), turn=[("y", 90)]):
        mirror(scene)
    with scene.group("On the back wall"):
        clock(scene)
        socket(scene, "Socket", (0.60, 1.16, 0.008))
    with scene.group("On the right wall", at=(ROOM_WIDTH, 0, 2.1), turn=[("y", -90)]):
        socket(scene, "Light switch", (0.0, 1.15, 0.0))
    # Opposite the mirror, in which the visitor sees it.
    with scene.group("Picture", at=(ROOM_WIDTH, 0, 2.1), turn=[("y", -90)]):
        poster(scene)


def clock(scene):
    with scene.group("Clock", at=(2.96, 2.37, 0)):
        rim = facing(lathe([(0.13, 0.0), (0.13, 0.02), (0.124, 0.031), (0.116, 0.031), (0.11, 0.014)], 26))
        face = facing(sweep(circle(26), [(0.111, 0.0135), (0.1, 0.0136)], cap_end=True))
        marks = Surface()
        for hour in range(12):
            w, a, b = (0.005, 0.078, 0.1) if hour % 3 == 0 else (0.003, 0.088, 0.1)
            mark = polygon([(-w, a, 0.0145), (w, a, 0.0145), (w, b, 0.0145), (-w, b, 0.0145)])
            marks.extend(mark.turned(("z", -30 * hour)))
        for angle, length, width, z in ((-305, 0.055, 0.006, 0.017), (-54, 0.088, 0.004, 0.020), (-222, 0.09, 0.0015, 0.023)):
            hand = polygon(
                [(-width, -0.015, z), (width, -0.015, z), (width * 0.6, length, z), (-width * 0.6, length, z)]
            )
            marks.extend(hand.turned(("z", angle)))
        scene.add("Clock", Model((p.YELLOW, rim), (p.PAPER, face), (p.BLACK, marks)))


def picture_frame(width, height, bar=0.022, depth=0.02):
    profile = [(0.0, 0.0), (0.0, depth - 0.004), (-0.004, depth), (-bar + 0.008, depth), (-bar, depth * 0.45)]
    return facing(sweep(rectangle(width, height), profile))


def poster(scene):
    width, height = 0.50, 0.64
    w, h = width / 2 - 0.022, height / 2 - 0.022
    picture = polygon(
        [(-w, -h, 0.009), (w, -h, 0.009), (w, h, 0.009), (-w, h, 0.009)], [(0, 1), (1, 1), (1, 0), (0, 0)]
    )
    with scene.group("Poster", at=(-1.35, 1.62, 0)):
        scene.add("Poster", Model((p.POSTER, picture), (p.DARK_WOOD, picture_frame(width, height))))


def mirror(scene):
    rim = facing(lathe([(0.19, 0.0), (0.19, 0.012), (0.183, 0.02), (0.173, 0.02), (0.166, 0.01)], 28))
    face = facing(sweep(circle(28), [(0.167, 0.0095), (0.16, 0.0096)], cap_end=True))
    with scene.group("Mirror", at=(0, 1.62, 0)):
        scene.add("Mirror", Model((p.MIRROR, face), (p.BRASS, rim)))


def socket(scene, name, at):
    plate = plain_front(0.08, 0.08, 0.008, 0.003)
    dish = facing(lathe([(0.022, 0.0079 + SINK), (0.02, 0.011), (0.018, 0.009), (0.0, 0.009)], 10))
    scene.add(name, Model((p.LACQUER_WHITE, plate), (p.LACQUER_WHITE, dish)), at=at)
