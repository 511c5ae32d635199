"""Points, poses and colours of messages, checked."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from space.transform import Transform, Vector
from text.sentences import say
from view.scene.drawn import UnusableMessageError, frame_name

if TYPE_CHECKING:
    from view.scene.drawn import Message

NO_ROTATION = (0.0, 0.0, 0.0, 0.0)
"""What a message has that nobody has filled in; RViz takes it for no rotation, and so do we."""


def frame_of(message: Message) -> str:
    """Return the frame in the header of a message. Raises UnusableMessageError without one."""
    frame = frame_name(message["header"]["frame_id"])
    if not frame:
        raise UnusableMessageError(
            say("header.frame_id is empty: nobody knows where to draw it; name its frame")
        )
    return frame


def vector(value: Message) -> Vector:
    """Return x, y and z, which may be no numbers."""
    return float(value["x"]), float(value["y"]), float(value["z"])


def transform(translation: Message, rotation: Message) -> Transform:
    """Return where something is. Raises UnusableMessageError for what is no place."""
    turned = (*vector(rotation), float(rotation["w"]))
    if turned == NO_ROTATION:
        turned = (0.0, 0.0, 0.0, 1.0)
    try:
        return Transform.of(vector(translation), turned)
    except ValueError:
        raise UnusableMessageError(
            say(
                "its place or rotation is not a number: {numbers}",
                numbers=", ".join(f"{number:g}" for number in (*vector(translation), *turned)),
            )
        ) from None


def pose(value: Message) -> Transform:
    """Return a `geometry_msgs/Pose`. Raises UnusableMessageError for what is no place."""
    return transform(value["position"], value["orientation"])


def colour(value: Message) -> tuple[int, int, int, int]:
    """Return a `std_msgs/ColorRGBA` as red, green, blue and opacity, 0 to 255."""
    red, green, blue, opacity = (_byte(value[name]) for name in "rgba")
    return red, green, blue, opacity


def _byte(share: Any) -> int:  # noqa: ANN401
    number = float(share)
    return round(255 * min(1.0, max(0.0, number))) if math.isfinite(number) else 0
