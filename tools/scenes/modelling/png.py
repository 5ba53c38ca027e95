# SPDX-License-Identifier: Apache-2.0
"""Writes 8-bit RGB PNG files, and turns linear colours into sRGB codes."""

import struct
import zlib


def srgb_code(linear):
    c = min(max(linear, 0.0), 1.0)
    encoded = 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055
    return int(encoded * 255 + 0.5)


def encode_png(width, height, pixel):
    """`pixel(x, y)` gives the linear RGB of the texel in column x of row y, row 0 on top."""
    rows = bytearray()
    previous = bytes(3 * width)
    for y in range(height):
        row = bytes(srgb_code(c) for x in range(width) for c in pixel(x, y))
        rows.append(2)  # filter "up": repeating rows become zeros
        rows.extend((a - b) & 255 for a, b in zip(row, previous))
        previous = row
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + _chunk(b"IHDR", header)
        + _chunk(b"IDAT", zlib.compress(bytes(rows), 9))
        + _chunk(b"IEND", b"")
    )


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
