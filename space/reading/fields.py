"""Fields of messages, whatever somebody has put into them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from space.transform import Transform
from text.sentences import say

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from space.drawing.shapes import Shape
    from space.transform import Vector
    from text.sentences import Words

FARTHEST_M = 1e6
"""A place farther away than this is a mistake."""
FARTHEST_FRAME_M = 1e8
"""Ten times what the frame `earth` of REP-105 can need; what is farther is no place."""
NANOSECONDS = 1e-9


class NotDrawnError(ValueError):
    """Why a message cannot be drawn; its text is a sentence for the user."""


@dataclass(frozen=True, eq=False)
class Drawable:
    """What a message shows, in its frame."""

    frame: str
    """Without a leading slash."""
    shapes: tuple[Shape, ...]
    stamp_s: float | None = None
    """When it was measured, by the publisher's clock; None if the message does not say."""
    remark: Words | None = None
    """What of it is not shown, and why."""


def field(tree: Any, path: str) -> Any:  # noqa: ANN401 - a message is a tree of anything
    """Return what is at a path such as `info.origin`. Raises NotDrawnError."""
    found = tree
    try:
        for name in path.split("."):
            found = found[name]
    except (IndexError, KeyError, TypeError):
        raise NotDrawnError(say("the message has no field {field}", field=path)) from None
    return found


def number(tree: Any, path: str) -> float:  # noqa: ANN401
    """Return a finite number. Raises NotDrawnError."""
    found = field(tree, path)
    if isinstance(found, bool) or not isinstance(found, (int, float, np.number)):
        raise NotDrawnError(say("{field} is not a number", field=path))
    if not math.isfinite(found):
        raise NotDrawnError(say("{field} is not a finite number", field=path))
    return float(found)


def finite(tree: Any, path: str, names: str) -> list[float]:  # noqa: ANN401
    """Return finite numbers with names of one letter each. Raises NotDrawnError."""
    found = field(tree, path)
    if type(found) is dict:
        # The quick way, as a path has hundreds of poses.
        values: list[Any] = [found.get(name) for name in names]
        if all(type(value) is float for value in values) and math.isfinite(sum(values)):
            return values
    return [number(tree, f"{path}.{name}") for name in names]


def whole(tree: Any, path: str) -> int:  # noqa: ANN401
    """Return a whole number. Raises NotDrawnError."""
    return int(number(tree, path))


def listed(tree: Any, path: str) -> Sequence[Any]:  # noqa: ANN401
    """Return a list. Raises NotDrawnError."""
    found = field(tree, path)
    if isinstance(found, (str, bytes, Mapping)) or not isinstance(found, Sequence):
        raise NotDrawnError(say("{field} is not a list", field=path))
    return found


def numbers(tree: Any, path: str) -> NDArray[np.float32]:  # noqa: ANN401
    """Return an array of numbers, as they are, infinities and NaN included."""
    found = field(tree, path)
    try:
        array = np.asarray(found, dtype=np.float32)
    except (TypeError, ValueError):
        raise NotDrawnError(say("{field} is not a list of numbers", field=path)) from None
    return array.reshape(-1)


def vector(tree: Any, path: str, farthest_m: float = FARTHEST_M) -> Vector:  # noqa: ANN401
    """Return x, y and z. Raises NotDrawnError."""
    x, y, z = finite(tree, path, "xyz")
    if max(abs(x), abs(y), abs(z)) > farthest_m:
        far = f"{farthest_m / 1000:g}"
        raise NotDrawnError(say("{field} is farther away than {km} km", field=path, km=far))
    return x, y, z


def pose(tree: Any, path: str) -> Transform:  # noqa: ANN401
    """Return a geometry_msgs/Pose. Raises NotDrawnError."""
    return _turned(vector(tree, f"{path}.position"), tree, f"{path}.orientation")


def transform(tree: Any, path: str) -> Transform:  # noqa: ANN401
    """Return a geometry_msgs/Transform. Raises NotDrawnError."""
    place = vector(tree, f"{path}.translation", FARTHEST_FRAME_M)
    return _turned(place, tree, f"{path}.rotation")


def _turned(place: Vector, tree: Any, path: str) -> Transform:  # noqa: ANN401
    """A quaternion of zeros, which is what messages have that nobody filled in, is no rotation."""
    x, y, z, w = finite(tree, path, "xyzw")
    if not (x or y or z or w):
        return Transform(place)
    return Transform.of(place, (x, y, z, w))


def frame(tree: Any) -> str:  # noqa: ANN401
    """Return the name of the frame in the header. Raises NotDrawnError."""
    name = str(field(tree, "header.frame_id")).lstrip("/")
    if not name:
        raise NotDrawnError(say("{field} is empty: the publisher names no frame", field="header.frame_id"))
    return name


def stamp_s(tree: Any) -> float | None:  # noqa: ANN401
    """Return the stamp of the header, None for zero, which means that there is none."""
    return number(tree, "header.stamp.sec") + number(tree, "header.stamp.nanosec") * NANOSECONDS or None


def table(tree: Any, path: str, names: str) -> NDArray[np.float32]:  # noqa: ANN401
    """Return a list of things with such numbers, one letter each, as (n, len(names)).

    Infinities and NaN are included. Raises NotDrawnError.
    """
    found = listed(tree, path)
    try:
        rows = [[float(one[name]) for name in names] for one in found]
    except (KeyError, TypeError, ValueError):
        raise NotDrawnError(say("{field} is not a list of {names}", field=path, names=", ".join(names))) from None
    return np.array(rows, dtype=np.float32).reshape(-1, len(names))


def is_near(array: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Return which rows are places: finite, and not farther away than can be."""
    near = np.ones(len(array), dtype=np.bool_)
    for axis in range(3):
        # NaN compares as False.
        near &= np.abs(array[:, axis]) <= FARTHEST_M
    return near
