"""Frames asked of a buffer server, which nothing offers here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rclpy.duration import Duration

from tf2_ros.buffer_interface import BufferInterface

if TYPE_CHECKING:
    from rclpy.node import Node


class BufferClient(BufferInterface):
    """Is there to be imported: it asks by an action, which Deck's own tf2_msgs does not have."""

    def __init__(
        self,
        node: Node,
        ns: str,
        check_frequency: float = 10.0,
        timeout_padding: Duration = Duration(seconds=2.0),  # noqa: B008 - it does not change
    ) -> None:
        del node, ns, check_frequency, timeout_padding
        raise NotImplementedError(_INSTEAD)


_INSTEAD = (
    "a BufferClient asks by the action tf2_msgs/action/LookupTransform, which is not here;"
    " take a Buffer and a TransformListener"
)
