# SPDX-License-Identifier: Apache-2.0
"""Profiles swept along outlines: the one primitive behind lathes, slabs, boxes, doors, frames, mouldings.

An outline is a curve in the horizontal plane with, at each point, the direction in which the profile leaves
it and the horizontal normal used for shading. A profile is a list of (offset, height) points; it travels so
that the outside of the object lies on its right hand: up the outer wall, then inwards over the top.
"""

import math
from dataclasses import dataclass

from .surface import Surface

CREASE = 55.0  # degrees: profile corners sharper than this are hard edges
CAP_WEIGHT = 1e3  # a cap is flat: it outweighs the bevel beside it


@dataclass
class Outline:
    points: list  # (x, z)
    offsets: list  # (x, z): where offset 1 leads; longer than 1 at mitred corners
    normals: list  # (x, z), unit
    closed: bool = True
    round: bool = False  # a circle about the origin, whose profile may touch the axis


def circle(segments, phase=0.0):
    """Radius 0: the profile's offsets are radii. The first point lies at angle `phase` (degrees) from +x to +z."""
    angles = [2 * math.pi * i / segments + math.radians(phase) for i in range(segments)]
    directions = [(math.cos(a), math.sin(a)) for a in angles]
    return Outline([(0.0, 0.0)] * segments, directions, directions, round=True)


def arc(segments, start, end):
    """Part of a circle from `start` to `end` degrees."""
    angles = [math.radians(start + (end - start) * i / segments) for i in range(segments + 1)]
    directions = [(math.cos(a), math.sin(a)) for a in angles]
    return Outline([(0.0, 0.0)] * len(angles), directions, directions, closed=False, round=True)


def rectangle(width, depth, radius=0.0, segments=1):
    """Centred; corners rounded by arcs, or sharp and mitred without a radius."""
    x, z = width / 2, depth / 2
    points, offsets, normals = [], [], []
    for k, (sx, sz) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        if radius == 0.0:
            for angle in (90 * k, 90 * k + 90):
                points.append((sx * x, sz * z))
                offsets.append((float(sx), float(sz)))
                normals.append((round(math.cos(math.radians(angle))) + 0.0, round(math.sin(math.radians(angle))) + 0.0))
        else:
            for i in range(segments + 1):
                angle = math.radians(90 * k + 90 * i / segments)
                n = (math.cos(angle), math.sin(angle))
                points.append((sx * (x - radius) + radius * n[0], sz * (z - radius) + radius * n[1]))
                offsets.append(n)
                normals.append(n)
    return Outline(points, offsets, normals)


def line(x0, x1):
    """From x0 to x1 on the x axis with the outside towards +z: the profile is (z, y)."""
    return Outline([(x1, 0.0), (x0, 0.0)], [(0.0, 1.0)] * 2, [(0.0, 1.0)] * 2, closed=False)


def polyline(points, closed=False):
    """Straight sides through points (x, z) with mitred corners; the outside lies to the left of the way, seen from
    above. Around a room it runs so that the outside is the room's inside."""
    count = len(points)
    result = Outline([], [], [], closed=closed)
    for i, p in enumerate(points):
        n0 = _side_normal(points[i - 1], p) if closed or i > 0 else None
        n1 = _side_normal(p, points[(i + 1) % count]) if closed or i < count - 1 else None
        both = [n for n in (n0, n1) if n]
        if len(both) == 2:
            k = 1.0 / (1.0 + n0[0] * n1[0] + n0[1] * n1[1])
            mitre = ((n0[0] + n1[0]) * k, (n0[1] + n1[1]) * k)
        else:
            mitre = both[0]
        for n in both:
            result.points.append(p)
            result.offsets.append(mitre)
            result.normals.append(n)
    return result


def _side_normal(a, b):
    dx, dz = b[0] - a[0], b[1] - a[1]
    size = math.hypot(dx, dz)
    return (dz / size, -dx / size)


def sweep(outline, profile, cap_start=False, cap_end=False, closed_profile=False, crease=CREASE):
    """Caps are flat and horizontal: the start cap faces down, the end cap up."""
    surface = Surface()
    segments = _profile_segments(outline, profile, cap_start, cap_end, closed_profile, crease)
    lengths = _arc_lengths(outline, sum(abs(p[0]) for p in profile) / len(profile))
    count = len(outline.points)
    edges = range(count) if outline.closed else range(count - 1)
    travelled = 0.0
    for p0, p1, n0, n1 in segments:
        step = math.hypot(p1[0] - p0[0], p1[1] - p0[1])
        for j in edges:
            k = (j + 1) % count
            corner = lambda q, p, n, v: (
                _position(outline, q, p),
                (outline.normals[q][0] * n[0], n[1], outline.normals[q][1] * n[0]),
                (lengths[j + (q != j)], v),
            )
            a0, a1 = corner(j, p0, n0, travelled), corner(j, p1, n1, travelled + step)
            b0, b1 = corner(k, p0, n0, travelled), corner(k, p1, n1, travelled + step)
            surface.quad(a0, a1, b1, b0)
        travelled += step
    if cap_end:
        surface.extend(_cap(outline, profile[-1], 1.0))
    if cap_start:
        surface.extend(_cap(outline, profile[0], -1.0))
    return surface


def _position(outline, j, p):
    return (
        outline.points[j][0] + outline.offsets[j][0] * p[0],
        p[1],
        outline.points[j][1] + outline.offsets[j][1] * p[0],
    )


def _arc_lengths(outline, radius):
    """Distance along the outline up to each point, one more for the closing edge."""
    mean = (
        (
            lambda j: (
                outline.points[j][0] + outline.offsets[j][0] * radius,
                outline.points[j][1] + outline.offsets[j][1] * radius,
            )
        )
        if outline.round
        else (lambda j: outline.points[j])
    )
    count, result = len(outline.points), [0.0]
    for j in range(count):
        a, b = mean(j), mean((j + 1) % count)
        result.append(result[-1] + math.hypot(b[0] - a[0], b[1] - a[1]))
    return result


def _profile_segments(outline, profile, cap_start, cap_end, closed, crease):
    """(start, end, normal at start, normal at end) in the (offset, height) plane. Normals of neighbours are
    blended, weighted by length squared, so that long faces stay flat between small bevels."""
    points = list(profile) + ([profile[0]] if closed else [])
    pieces = []
    for p0, p1 in zip(points, points[1:]):
        size = math.hypot(p1[0] - p0[0], p1[1] - p0[1])
        pieces.append(((p1[1] - p0[1]) / size, (p0[0] - p1[0]) / size, size))
    before = pieces[-1] if closed else _neighbour(outline, profile[0], pieces[0], cap_start, -1.0)
    after = pieces[0] if closed else _neighbour(outline, profile[-1], pieces[-1], cap_end, 1.0)
    chain = [before, *pieces, after]
    limit = math.cos(math.radians(crease))
    result = []
    for i, (p0, p1) in enumerate(zip(points, points[1:])):
        own = chain[i + 1]
        result.append((p0, p1, _blend(own, chain[i], limit), _blend(own, chain[i + 2], limit)))
    return result


def _neighbour(outline, point, piece, cap, up):
    if cap:
        return (0.0, up, CAP_WEIGHT)
    if outline.round and point[0] == 0.0:  # on the axis: its own mirror image lies beyond
        return (-piece[0], piece[1], piece[2])
    return None


def _blend(own, other, limit):
    if other is None or own[0] * other[0] + own[1] * other[1] < limit:
        return own[:2]
    w0, w1 = own[2] ** 2, other[2] ** 2
    n = (own[0] * w0 + other[0] * w1, own[1] * w0 + other[1] * w1)
    size = math.hypot(*n)
    return (n[0] / size, n[1] / size)


def _cap(outline, p, up):
    """Triangles zigzag between the two halves of a convex loop: no long fans."""
    loop = []
    for j in range(len(outline.points)):
        q = _position(outline, j, p)
        if not loop or math.dist(q, loop[-1]) > 1e-6:
            loop.append(q)
    if math.dist(loop[0], loop[-1]) < 1e-6:
        loop.pop()
    surface = Surface()
    corner = lambda i: (loop[i], (0.0, up, 0.0), (loop[i][0], loop[i][2]))
    low, high = 0, len(loop) - 1
    while high - low >= 2:
        for a, b, c, advance in ((low, low + 1, high, (1, 0)), (low + 1, high - 1, high, (0, -1))):
            if high - low < 2:
                break
            if advance == (1, 0):
                a, b, c = low, low + 1, high
            else:
                a, b, c = low, high - 1, high
            # The loop runs from +x to +z, clockwise seen from above.
            surface.triangle(*((corner(c), corner(b), corner(a)) if up > 0 else (corner(a), corner(b), corner(c))))
            low, high = low + advance[0], high + advance[1]
    return surface


def lathe(profile, segments, cap_end=False, phase=0.0, crease=CREASE):
    """Profile of (radius, height), outside on the right hand of its travel."""
    return sweep(circle(segments, phase), profile, cap_end=cap_end, crease=crease)


def bevelled(height, bevel, bottom=False):
    """Profile of a slab from y = 0 to `height`: offsets are measured from the outline inwards."""
    start = [(-bevel, 0.0), (0.0, bevel)] if bottom else [(0.0, 0.0)]
    return start + [(0.0, height - bevel), (-bevel, height)]


def slab(width, depth, height, bevel=0.003, radius=None, segments=1, bottom=False):
    """A box standing on y = 0 with softened edges; without `bottom` it is open below, for what stands on
    something."""
    outline = rectangle(width, depth, bevel if radius is None else radius, segments)
    return sweep(outline, bevelled(height, bevel, bottom), cap_start=bottom, cap_end=True)


def disc_outline_slab(radius, height, bevel, segments, bottom=False):
    start = [(radius - bevel, 0.0), (radius, bevel)] if bottom else [(radius, 0.0)]
    return sweep(
        circle(segments), start + [(radius, height - bevel), (radius - bevel, height)], cap_start=bottom, cap_end=True
    )
