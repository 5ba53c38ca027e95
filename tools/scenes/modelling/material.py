# SPDX-License-Identifier: Apache-2.0
"""Materials of glTF's metallic-roughness model, and the textures they use. Colours are linear RGB."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Texture:
    name: str
    png: bytes
    size: tuple  # metres that one repeat covers in u and v


@dataclass(frozen=True)
class Material:
    name: str
    color: tuple = (0.8, 0.8, 0.8)
    roughness: float = 1.0
    metallic: float = 0.0
    specular: float = 0.0  # 0: matte, spawns no glossy rays
    transmission: float = 0.0
    emission: tuple = (0.0, 0.0, 0.0)  # radiance
    texture: Texture = None
    double_sided: bool = False


def matte(name, color, **more):
    return Material(name, color, **more)


def glossy(name, color, roughness, **more):
    return Material(name, color, roughness, specular=1.0, **more)


def metal(name, color, roughness=0.0, **more):
    return Material(name, color, roughness, metallic=1.0, specular=1.0, **more)


def glass(name, color=(0.97, 0.97, 0.97)):
    """A thin pane, seen from both sides."""
    return Material(name, color, 0.0, specular=1.0, transmission=1.0, double_sided=True)


def emitter(name, radiance):
    return Material(name, (0.0, 0.0, 0.0), emission=radiance)
