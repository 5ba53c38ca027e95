# SPDX-License-Identifier: Apache-2.0
"""Small polygonal modeller for the scenes that are made by code: surfaces, primitives, materials, glTF.

Only Python's standard library is used, and equal input gives equal bytes. Lengths are metres, +y is up,
triangles run counter-clockwise seen from outside.
"""
