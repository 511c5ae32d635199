"""Where one frame is in another: a translation and a rotation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Vector: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]

NEARLY_EQUAL = 0.9995
"""Above this cosine, the straight line between two quaternions is as good as the arc."""
UPRIGHT = 1.0 - 1e-9
"""A sine of the pitch from which on roll and yaw turn about the same axis."""


@dataclass(frozen=True)
class Transform:
    """Where a child frame is in its parent: it turns the child's coordinates into the parent's."""

    translation: Vector = (0.0, 0.0, 0.0)
    """Metres."""
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)
    """Of length 1."""

    @classmethod
    def of(cls, translation: Vector, rotation: Quaternion) -> Transform:
        """Return a transform, with the quaternion scaled to length 1.

        Raises ValueError for numbers that are not finite, and for a quaternion of length 0.
        """
        if not all(map(math.isfinite, (*translation, *rotation))):
            raise ValueError("a transform of numbers that are not finite")
        length = math.hypot(*rotation)
        if not length:
            raise ValueError("a quaternion of length 0")
        x, y, z, w = rotation
        return cls(translation, (x / length, y / length, z / length, w / length))

    @classmethod
    def from_rpy(cls, translation: Vector, rpy_rad: Vector) -> Transform:
        """Return roll about x, then pitch about y, then yaw about z, all about fixed axes."""
        return cls(translation, quaternion_from_rpy(*rpy_rad))

    def __matmul__(self, inner: Transform) -> Transform:
        """Return `inner`, which is given in this transform's child, in this one's parent."""
        x, y, z = rotated(self.rotation, inner.translation)
        a, b, c = self.translation
        return Transform((a + x, b + y, c + z), product(self.rotation, inner.rotation))

    def inverse(self) -> Transform:
        """Return where the parent is in the child."""
        x, y, z, w = self.rotation
        back = (-x, -y, -z, w)
        a, b, c = rotated(back, self.translation)
        return Transform((-a, -b, -c), back)

    def between(self, other: Transform, share: float) -> Transform:
        """Return what is between the two: `share` 0 is this one, 1 the other.

        Translations change linearly, rotations at a steady rate by the shorter way round (slerp).
        """
        a, b = self.translation, other.translation
        moved = (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share)
        return Transform(moved, slerp(self.rotation, other.rotation, share))

    def point(self, point: Vector) -> Vector:
        """Return a point of the child in the parent."""
        x, y, z = rotated(self.rotation, point)
        a, b, c = self.translation
        return a + x, b + y, c + z

    def points(self, points: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return points of the child in the parent: an array of shape (n, 3), of the same kind."""
        return turned(points, self.matrix()[:3, :3], self.translation)

    def matrix(self) -> NDArray[np.float64]:
        """Return the 4x4 matrix that turns (x, y, z, 1) of the child into that of the parent."""
        import numpy as np

        x, y, z, w = self.rotation
        a, b, c = self.translation
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), a],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), b],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), c],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )

    @property
    def rpy_rad(self) -> Vector:
        """Roll, pitch and yaw; straight up or down, where only their sum is known, roll is 0."""
        x, y, z, w = self.rotation
        sine = 2 * (w * y - z * x)
        if abs(sine) >= UPRIGHT:
            return (0.0, math.copysign(math.pi / 2, sine), _wrapped(-2 * math.copysign(1, sine) * math.atan2(x, w)))
        roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        return roll, math.asin(sine), math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


IDENTITY = Transform()


def turned(
    points: NDArray[np.floating], matrix: NDArray[np.floating], shift: Vector = (0.0, 0.0, 0.0)
) -> NDArray[np.floating]:
    """Return `matrix @ point + shift` for points of shape (n, 3), axis by axis in memory.

    numpy's own product takes ten times as long for matrices as narrow as these.
    """
    import numpy as np

    x, y, z = points[:, 0], points[:, 1], points[:, 2]
    whole = np.empty((3, len(points)), dtype=points.dtype)
    for axis, (a, b, c) in enumerate(matrix.tolist()):
        out = whole[axis]
        np.multiply(x, points.dtype.type(a), out=out)
        out += y * points.dtype.type(b)
        out += z * points.dtype.type(c)
        out += points.dtype.type(shift[axis])
    return whole.T


def quaternion_from_rpy(roll_rad: float, pitch_rad: float, yaw_rad: float) -> Quaternion:
    """Return roll about x, then pitch about y, then yaw about z, all about fixed axes (REP-103)."""
    sr, cr = math.sin(roll_rad / 2), math.cos(roll_rad / 2)
    sp, cp = math.sin(pitch_rad / 2), math.cos(pitch_rad / 2)
    sy, cy = math.sin(yaw_rad / 2), math.cos(yaw_rad / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


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


def rotated(rotation: Quaternion, vector: Vector) -> Vector:
    """Return a vector after a rotation."""
    x, y, z, w = rotation
    a, b, c = vector
    # v + 2 w (q x v) + 2 q x (q x v), which takes half the products of q v q*.
    p, q, r = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p


def slerp(a: Quaternion, b: Quaternion, share: float) -> Quaternion:
    """Return the rotation between two, by the shorter way round.

    Source: Shoemake, Animating Rotation with Quaternion Curves, 1985.
    """
    cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    sign, cosine = math.copysign(1.0, cosine), abs(cosine)
    if cosine > NEARLY_EQUAL:
        left, right = 1.0 - share, sign * share
    else:
        angle = math.acos(cosine)
        left = math.sin((1.0 - share) * angle) / math.sin(angle)
        right = sign * math.sin(share * angle) / math.sin(angle)
    x, y, z, w = (p * left + q * right for p, q in zip(a, b, strict=True))
    length = math.hypot(x, y, z, w)
    return x / length, y / length, z / length, w / length


def _wrapped(angle_rad: float) -> float:
    return math.remainder(angle_rad, math.tau)
