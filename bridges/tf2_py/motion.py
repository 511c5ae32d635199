"""A translation and a rotation, plainly as numbers; quaternions are (x, y, z, w)."""

from __future__ import annotations

import math
from dataclasses import dataclass

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

_NEARLY_PARALLEL = 0.9995
"""Above this cosine the straight line differs from the arc by less than rounding does."""


@dataclass(frozen=True)
class Motion:
    """Where a child frame is in its parent."""

    translation: Vector = (0.0, 0.0, 0.0)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def then(self, inner: Motion) -> Motion:
        """Return `inner`, which is within this one, as seen from outside."""
        moved = rotate(self.rotation, inner.translation)
        return Motion(added(self.translation, moved), product(self.rotation, inner.rotation))

    def inverse(self) -> Motion:
        """Return where the parent is in the child."""
        x, y, z, w = self.rotation
        back = (-x, -y, -z, w)
        a, b, c = rotate(back, self.translation)
        return Motion((-a, -b, -c), back)

    def towards(self, other: Motion, share: float) -> Motion:
        """Return what is between two motions; `share` 0 is this one, 1 the other."""
        a, b = self.translation, other.translation
        moved = (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share)
        return Motion(moved, slerp(self.rotation, other.rotation, share))


def added(a: Vector, b: Vector) -> Vector:
    """Return the sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation `b` followed by the rotation `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(turn: Quaternion, vector: Vector) -> Vector:
    """Return a vector after a rotation."""
    x, y, z, w = turn
    inside = product(product(turn, (*vector, 0.0)), (-x, -y, -z, w))
    return inside[0], inside[1], inside[2]


def unit(turn: Quaternion) -> Quaternion:
    """Return a quaternion of length 1."""
    length = math.hypot(*turn)
    return turn[0] / length, turn[1] / length, turn[2] / length, turn[3] / length


def slerp(a: Quaternion, b: Quaternion, share: float) -> Quaternion:
    """Return the rotation between two, by the shorter way round."""
    cosine = sum(p * q for p, q in zip(a, b, strict=True))
    sign = -1.0 if cosine < 0 else 1.0
    cosine = abs(cosine)
    if cosine > _NEARLY_PARALLEL:
        left, right = 1.0 - share, share
    else:
        angle = math.acos(cosine)
        left = math.sin((1.0 - share) * angle) / math.sin(angle)
        right = math.sin(share * angle) / math.sin(angle)
    right *= sign
    return unit(
        (
            a[0] * left + b[0] * right,
            a[1] * left + b[1] * right,
            a[2] * left + b[2] * right,
            a[3] * left + b[3] * right,
        )
    )
