# SPDX-License-Identifier: Apache-2.0
"""Vectors as tuples, and rotations as unit quaternions (x, y, z, w) like glTF's."""

import math

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
NO_ROTATION = (0.0, 0.0, 0.0, 1.0)


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalize(a):
    return scale(a, 1.0 / length(a))


def lerp(a, b, t):
    return add(scale(a, 1.0 - t), scale(b, t))


def quaternion(axis, degrees):
    half = math.radians(degrees) / 2
    return (*scale(AXES[axis], math.sin(half)), math.cos(half))


def quaternion_product(a, b):
    """The rotation that does b first, then a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotation(*turns):
    """Turns like ("y", 30), ("x", -10), done in that order about the fixed axes."""
    result = NO_ROTATION
    for axis, degrees in turns:
        result = quaternion_product(quaternion(axis, degrees), result)
    return result


def rotate(q, v):
    u = q[:3]
    t = scale(cross(u, v), 2.0)
    return add(add(v, scale(t, q[3])), cross(u, t))


def look_rotation(eye, target):
    """Rotation of a camera at eye, looking down its -z towards target with +y up."""
    z = normalize(sub(eye, target))
    x = normalize(cross((0.0, 1.0, 0.0), z))
    y = cross(z, x)
    # Shepperd's method for the case of a positive trace or the largest diagonal element.
    m = ((x[0], y[0], z[0]), (x[1], y[1], z[1]), (x[2], y[2], z[2]))
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace > 0:
        w = math.sqrt(1 + trace) / 2
        return ((m[2][1] - m[1][2]) / (4 * w), (m[0][2] - m[2][0]) / (4 * w), (m[1][0] - m[0][1]) / (4 * w), w)
    i = max(range(3), key=lambda k: m[k][k])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = math.sqrt(1 + m[i][i] - m[j][j] - m[k][k]) / 2
    q = [0.0, 0.0, 0.0, (m[k][j] - m[j][k]) / (4 * s)]
    q[i], q[j], q[k] = s, (m[j][i] + m[i][j]) / (4 * s), (m[k][i] + m[i][k]) / (4 * s)
    return tuple(q)
