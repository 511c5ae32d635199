"""Moving what has a frame, such as a PointStamped, into another frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from rclpy.duration import Duration
from rclpy.time import Time

if TYPE_CHECKING:
    from collections.abc import Callable

    Move = Callable[[Any, Any], Any]


class TypeException(Exception):  # noqa: N818 - tf2's own names
    """Nobody has told how to move things of this type."""


class NotImplementedException(Exception):  # noqa: N818
    """What should be done here is done by another class."""


class TransformRegistration:
    """How things of a type are moved; modules such as tf2_geometry_msgs tell it."""

    _moves: ClassVar[dict[type, Move]] = {}

    def add(self, key: type, callback: Move) -> None:
        """Tell how things of a type are moved by a TransformStamped."""
        self._moves[key] = callback

    def get(self, key: type) -> Move:
        """Return how things of a type are moved."""
        try:
            return self._moves[key]
        except KeyError:
            raise TypeException(
                f"Type {key} is not loaded or supported; for messages of geometry_msgs, import tf2_geometry_msgs"
            ) from None


class BufferInterface:
    """What can be done with anything that can look up a transform."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self,
        object_stamped: Any,
        target_frame: str,
        timeout: Duration = Duration(),  # noqa: B008 - it does not change
    ) -> Any:
        """Return a thing with a header as seen from another frame, at its own time."""
        move = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform(target_frame, header.frame_id, Time.from_msg(header.stamp), timeout)
        return move(object_stamped, found)

    def lookup_transform(self, *_args: Any, **_kwargs: Any) -> Any:
        """Return the transform that is needed for it."""
        raise NotImplementedException
