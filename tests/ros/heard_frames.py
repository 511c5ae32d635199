"""The frames in messages of /tf and /tf_static that a test has heard."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from space.buffer import Stamped, TransformBuffer
from space.transform import Transform

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tf2_msgs.msg import TFMessage


def children(message: TFMessage) -> set[str]:
    """The frames of which it says where they are."""
    return {transform.child_frame_id for transform in message.transforms}


def buffer_of(fixed: Sequence[TFMessage], moved: Sequence[TFMessage]) -> TransformBuffer:
    """All that was heard of /tf_static and of /tf."""
    buffer = TransformBuffer(keep_s=math.inf)
    for static, messages in ((True, fixed), (False, moved)):
        for one in (one for message in messages for one in message.transforms):
            place, turn, stamp = one.transform.translation, one.transform.rotation, one.header.stamp
            transform = Transform.of((place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w))
            stamp_s = stamp.sec + stamp.nanosec / 1e9
            found = Stamped(
                one.header.frame_id, one.child_frame_id, stamp_s, transform, static=static
            )
            buffer.add([found])
    return buffer
