"""Peers that publish frames, and the rows of those that an observer has found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graph.frames.reading import TF_MESSAGE
from tests.waiting import wait_until

if TYPE_CHECKING:
    from graph.data import FrameRow
    from tests.ros.observing import Peer, Watcher
    from tests.unit.transform_messages import Sent


def value(*sent: Sent) -> dict[str, Any]:
    """A message as a peer takes it."""
    return {
        "transforms": [
            {
                "header": {
                    "stamp": {"sec": int(one.stamp_s), "nanosec": 0},
                    "frame_id": one.parent,
                },
                "child_frame_id": one.child,
                "transform": {
                    "translation": dict(zip("xyz", one.translation, strict=True)),
                    "rotation": dict(zip("xyzw", one.rotation, strict=True)),
                },
            }
            for one in sent
        ]
    }


def frames(watcher: Watcher, child: str) -> list[FrameRow]:
    return [row for row in watcher.update.frames if row.newest.child == child]


def see(watcher: Watcher, child: str, test: Any, what: str) -> FrameRow:
    """Wait for a row of this frame that passes."""
    return wait_until(
        lambda: next((row for row in frames(watcher, child) if test(row)), None), f"{child}: {what}"
    )


def repeat(peer: Peer, hz: float, *sent: Sent) -> None:
    peer.advertise("/tf", type_name=TF_MESSAGE)
    peer.repeat("/tf", value=value(*sent), hz=hz)


def latch(peer: Peer, *sent: Sent) -> None:
    peer.advertise("/tf_static", type_name=TF_MESSAGE, durability="transient_local", depth=1)
    peer.publish("/tf_static", value=value(*sent))
