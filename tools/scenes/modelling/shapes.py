# SPDX-License-Identifier: Apache-2.0
"""Tubes along paths, sheets over a parameter square, flat polygons."""

import math

from .surface import Surface
from .vectors import add, cross, dot, length, lerp, normalize, scale, sub


def polygon(points, uv=None):
    """A flat convex polygon, counter-clockwise seen from its front."""
    normal = normalize(cross(sub(points[1], points[0]), sub(points[2], points[0])))
    coordinates = uv or [(0.0, 0.0)] * len(points)
    corners = [(p, normal, t) for p, t in zip(points, coordinates)]
    surface = Surface()
    for i in range(1, len(points) - 1):
        surface.triangle(corners[0], corners[i], corners[i + 1])
    return surface


def quad(origin, u, v):
    """The parallelogram of edges u and v, facing u x v, with uv in metres."""
    a, b = length(u), length(v)
    return polygon(
        [origin, add(origin, u), add(add(origin, u), v), add(origin, v)], [(0.0, b), (a, b), (a, 0.0), (0.0, 0.0)]
    )


def tube(path, radius, sides, caps=(True, True), flatten=1.0, up=None, closed=False):
    """Round bar along `path`. `radius` is one number or one per point; `flatten` squeezes the section along
    its second axis, `up` sets where that axis points at the start."""
    radii = list(radius) if isinstance(radius, (list, tuple)) else [radius] * len(path)
    frames = _frames(path, up, closed)
    rings = []
    for point, r, (tangent, u, v) in zip(path, radii, frames):
        ring = []
        for k in range(sides):
            a = 2 * math.pi * k / sides
            c, s = math.cos(a), math.sin(a)
            place = add(point, add(scale(u, r * c), scale(v, r * s * flatten)))
            normal = normalize(add(scale(u, c * flatten), scale(v, s)))
            ring.append((place, normal))
        rings.append(ring)
    surface = Surface()
    spans = len(path) if closed else len(path) - 1
    travelled = 0.0
    for i in range(spans):
        j = (i + 1) % len(path)
        step = length(sub(path[j], path[i]))
        slope = (radii[i] - radii[j]) / step
        tilt = lambda n, t: normalize(add(n, scale(t, slope)))
        for k in range(sides):
            m = (k + 1) % sides
            corner = lambda ring, q, frame, uv: (ring[q][0], tilt(ring[q][1], frame[0]), uv)
            girth = 2 * math.pi * radii[i] / sides
            a = corner(rings[i], k, frames[i], (travelled, k * girth))
            b = corner(rings[i], m, frames[i], (travelled, (k + 1) * girth))
            c = corner(rings[j], m, frames[j], (travelled + step, (k + 1) * girth))
            d = corner(rings[j], k, frames[j], (travelled + step, k * girth))
            surface.quad(a, b, c, d)
        travelled += step
    if not closed:
        for wanted, ring, (tangent, _, _), sign in (
            (caps[0], rings[0], frames[0], -1),
            (caps[1], rings[-1], frames[-1], 1),
        ):
            if wanted:
                surface.extend(_disc([p for p, _ in ring], scale(tangent, sign), sign < 0))
    return surface


def _disc(points, normal, reverse):
    order = list(reversed(points)) if reverse else list(points)
    surface = Surface()
    for i in range(1, len(order) - 1):
        surface.triangle(*((p, normal, (0.0, 0.0)) for p in (order[0], order[i], order[i + 1])))
    return surface


def _frames(path, up, closed):
    """(tangent, u, v) per point, carried along with the least twist."""
    count = len(path)
    tangents = []
    for i in range(count):
        before = path[i - 1] if i > 0 or closed else path[0]
        after = path[(i + 1) % count] if i < count - 1 or closed else path[-1]
        tangents.append(normalize(sub(after, before)))
    if up is None:
        up = (0.0, 1.0, 0.0) if abs(tangents[0][1]) < 0.9 else (1.0, 0.0, 0.0)
    v = up
    frames = []
    for t in tangents:
        v = normalize(sub(v, scale(t, dot(v, t))))
        frames.append((t, cross(v, t), v))
    return frames


def bend(points, radius, steps):
    """Replaces the inner corners of a polyline by arcs of `steps` segments."""
    result = [points[0]]
    for a, b, c in zip(points, points[1:], points[2:]):
        d0, d1 = normalize(sub(a, b)), normalize(sub(c, b))
        half = math.acos(max(-1.0, min(1.0, dot(d0, d1)))) / 2
        reach = radius / math.tan(half)
        centre = add(b, scale(normalize(add(d0, d1)), radius / math.sin(half)))
        start, end = sub(add(b, scale(d0, reach)), centre), sub(add(b, scale(d1, reach)), centre)
        angle = math.pi - 2 * half
        for i in range(steps + 1):
            t = i / steps
            w0, w1 = math.sin((1 - t) * angle) / math.sin(angle), math.sin(t * angle) / math.sin(angle)
            result.append(add(centre, add(scale(start, w0), scale(end, w1))))
    result.append(points[-1])
    return result


def curve(points, steps):
    """Catmull-Rom spline through the points, `steps` segments per span."""
    ends = [sub(scale(points[0], 2.0), points[1]), *points, sub(scale(points[-1], 2.0), points[-2])]
    result = []
    for i in range(1, len(ends) - 2):
        p0, p1, p2, p3 = ends[i - 1 : i + 3]
        for s in range(steps):
            t = s / steps
            c = add(
                scale(p1, 2.0),
                add(
                    scale(sub(p2, p0), t),
                    add(
                        scale(add(sub(scale(p0, 2.0), scale(p1, 5.0)), sub(scale(p2, 4.0), p3)), t * t),
                        scale(add(sub(scale(p1, 3.0), p0), sub(p3, scale(p2, 3.0))), t * t * t),
                    ),
                ),
            )
            result.append(scale(c, 0.5))
    result.append(points[-1])
    return result


def sheet(f, columns, rows, uv=lambda s, t: (s, t)):
    """The surface f(s, t), s and t from 0 to 1, facing df/ds x df/dt."""
    h = 1e-4

    def corner(s, t):
        s0, s1, t0, t1 = max(s - h, 0.0), min(s + h, 1.0), max(t - h, 0.0), min(t + h, 1.0)
        du, dv = sub(f(s1, t), f(s0, t)), sub(f(s, t1), f(s, t0))
        n = cross(du, dv)
        if length(n) < 1e-14:  # where an edge shrinks to a point: the normal just beside it
            s, t = min(max(s, 0.02), 0.98), min(max(t, 0.02), 0.98)
            n = cross(sub(f(s + h, t), f(s - h, t)), sub(f(s, t + h), f(s, t - h)))
        return normalize(n)

    surface = Surface()
    points = {}
    for i in range(columns + 1):
        for j in range(rows + 1):
            s, t = i / columns, j / rows
            points[i, j] = (f(s, t), corner(s, t), uv(s, t))
    for i in range(columns):
        for j in range(rows):
            surface.quad(points[i, j], points[i + 1, j], points[i + 1, j + 1], points[i, j + 1])
    return surface


__all__ = ["bend", "curve", "lerp", "polygon", "quad", "sheet", "tube"]
