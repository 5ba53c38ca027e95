# SPDX-License-Identifier: Apache-2.0
"""Every material of the kitchen. Matte ones have no specular lobe; glossy ones keep glTF's 4 %."""

from modelling.material import emitter, glass, glossy, matte, metal

from . import textures

# Room
WALL_WHITE = matte("White wall", (0.74, 0.73, 0.70))
WALL_GREEN = matte("Green wall", (0.42, 0.62, 0.34))
WALL_ORANGE = matte("Terracotta wall", (0.72, 0.36, 0.18))
CEILING = matte("Ceiling", (0.79, 0.79, 0.78))
WOODWORK = matte("White woodwork", (0.76, 0.76, 0.74))
FLOOR = glossy("Floor tiles", (1.0, 1.0, 1.0), 0.25, texture=textures.FLOOR_TILES)
SPLASHBACK = glossy("Glazed tiles", (0.80, 0.80, 0.77), 0.08)
GROUT = matte("Grout", (0.45, 0.44, 0.42))

# Cabinets
TEAL = glossy("Teal lacquer", (0.055, 0.36, 0.38), 0.3)
LACQUER_WHITE = glossy("White lacquer", (0.80, 0.80, 0.79), 0.12)
CARCASS = matte("Carcass", (0.30, 0.33, 0.33))
PLINTH = matte("Plinth", (0.20, 0.21, 0.22))
WORKTOP = glossy("Oiled oak", (1.0, 1.0, 1.0), 0.35, texture=textures.OAK_STAVES)
TABLE_WOOD = glossy("Varnished pine", (1.0, 1.0, 1.0), 0.2, texture=textures.PINE)
WOOD = matte("Beech", (0.62, 0.42, 0.24))
DARK_WOOD = matte("Walnut", (0.25, 0.13, 0.07))

WICKER = matte("Wicker", (0.58, 0.40, 0.20))

# Metals and glass
CHROME = metal("Chrome", (0.83, 0.83, 0.84), 0.0)
STEEL = metal("Polished steel", (0.74, 0.74, 0.75), 0.08)
BRUSHED = metal("Brushed steel", (0.68, 0.68, 0.69), 0.2)
COPPER = metal("Copper", (0.85, 0.50, 0.35), 0.12)
BRASS = metal("Brass", (0.83, 0.64, 0.30), 0.15)
MIRROR = metal("Mirror", (0.85, 0.85, 0.85), 0.0)
IRON = matte("Cast iron", (0.06, 0.06, 0.065))
BLACK_GLASS = glossy("Black glass", (0.02, 0.02, 0.022), 0.0)
BLACK = matte("Black plastic", (0.05, 0.05, 0.05))
GLASS = glass("Clear glass")
BLUE_GLASS = glass("Blue glass", (0.62, 0.82, 0.90))
GREEN_GLASS = glass("Green glass", (0.42, 0.78, 0.40))
BROWN_GLASS = glass("Amber glass", (0.80, 0.42, 0.12))

# Strong colours
RED_ENAMEL = glossy("Red enamel", (0.66, 0.045, 0.03), 0.06)
ORANGE = matte("Orange", (0.82, 0.27, 0.03))
YELLOW = glossy("Yellow glaze", (0.82, 0.60, 0.03), 0.1)
YELLOW_MATTE = matte("Yellow", (0.82, 0.62, 0.06))
BLUE = matte("Blue", (0.05, 0.16, 0.55))
SKY_BLUE = matte("Sky blue", (0.22, 0.50, 0.72))
RED = matte("Red", (0.68, 0.06, 0.05))
PINK = matte("Pink", (0.80, 0.38, 0.40))
VIOLET = matte("Violet", (0.28, 0.12, 0.42))
GREEN = matte("Green", (0.10, 0.42, 0.08))
LEAF = matte("Leaf", (0.12, 0.40, 0.07), double_sided=True)
HERB = matte("Herb", (0.22, 0.50, 0.10), double_sided=True)
CREAM = matte("Cream", (0.78, 0.70, 0.54))
TERRACOTTA = matte("Terracotta", (0.60, 0.24, 0.12))
EARTH = matte("Earth", (0.09, 0.055, 0.035))
PORCELAIN = glossy("White porcelain", (0.82, 0.82, 0.80), 0.05)
BLUE_GLAZE = glossy("Blue glaze", (0.06, 0.20, 0.58), 0.08)
GREEN_GLAZE = glossy("Green glaze", (0.10, 0.45, 0.20), 0.1)
PAPER = matte("Paper", (0.78, 0.76, 0.70))
LINEN = matte("Linen", (0.72, 0.66, 0.54), double_sided=True)
CURTAIN = matte("Curtain", (0.82, 0.30, 0.10), double_sided=True)
TOWEL = matte("Checked towel", (1.0, 1.0, 1.0), texture=textures.TEA_TOWEL, double_sided=True)
POSTER = matte("Poster", (1.0, 1.0, 1.0), texture=textures.POSTER)
RUG = matte("Rug", (1.0, 1.0, 1.0), texture=textures.RUG)

ORANGE_LACQUER = glossy("Orange lacquer", (0.82, 0.27, 0.03), 0.15)
WHITE_INSIDE = matte("White inside", (0.84, 0.83, 0.80))
CHAIR_RED = glossy("Red chair", (0.68, 0.06, 0.04), 0.3)
CHAIR_YELLOW = glossy("Yellow chair", (0.82, 0.58, 0.04), 0.3)
CHAIR_BLUE = glossy("Blue chair", (0.06, 0.24, 0.60), 0.3)
CHAIR_GREEN = glossy("Green chair", (0.20, 0.50, 0.10), 0.3)
FLOWER = matte("Petals", (0.80, 0.30, 0.42), double_sided=True)

# Food
PEEL_ORANGE = matte("Orange peel", (0.84, 0.33, 0.02))
PEEL_LEMON = matte("Lemon peel", (0.84, 0.68, 0.06))
APPLE_RED = glossy("Red apple", (0.56, 0.04, 0.03), 0.2)
APPLE_GREEN = glossy("Green apple", (0.38, 0.58, 0.07), 0.2)
BANANA = matte("Banana", (0.82, 0.62, 0.09))
CRUST = matte("Crust", (0.50, 0.24, 0.08))
PASTA = matte("Pasta", (0.80, 0.58, 0.24))
COFFEE = matte("Coffee beans", (0.12, 0.055, 0.03))
RICE = matte("Rice", (0.80, 0.77, 0.68))
BEANS = matte("Kidney beans", (0.36, 0.05, 0.04))
TOMATO = glossy("Tomato", (0.66, 0.05, 0.02), 0.1)

# Lights: radiance in W/(sr m^2)
DAYLIGHT = emitter("Daylight", (30.0, 32.5, 35.0))
LAMPLIGHT = emitter("Lamplight", (70.0, 59.0, 43.0))
