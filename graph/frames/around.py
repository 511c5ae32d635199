"""What an update tells of frames besides the frames themselves, and all that is wrong with them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.frames.book import FRAME_TOPICS, MOST_FRAMES
from graph.frames.reading import TF_MESSAGE
from graph.qos import VOLATILE
from space.tree.findings import Surroundings, frame_findings
from text.ros_names import TF_STATIC

if TYPE_CHECKING:
    from graph.data import GraphUpdate
    from space.tree.finding import FrameFinding
    from space.tree.tree import FrameTree

CLOCK = "/clock"


def findings_in(update: GraphUpdate, tree: FrameTree) -> list[FrameFinding]:
    """Return what is wrong with the frames of an update, which this tree was made of."""
    return frame_findings(tree, update.frames, surroundings(update))


def is_settling(update: GraphUpdate) -> bool:
    """Return whether somebody publishes /tf_static, and its frames are still to come.

    What has come before comes again, because it is latched; what has not is not waited for long.
    """
    return not any(row.is_static for row in update.frames) and any(
        row.name == TF_STATIC and row.publishers and (row.count or row.trouble is None) for row in update.topics
    )


def surroundings(update: GraphUpdate) -> Surroundings:
    """Return what the topics tell: frames that headers name, frames on other topics."""
    volatile = [
        end.called
        for row in update.topics
        if row.name == TF_STATIC
        for end in row.published_by
        if end.durability == VOLATILE
    ]
    return Surroundings(
        named={row.name: row.frame_id for row in update.topics if row.frame_id},
        elsewhere={
            row.name: row.subscribers
            for row in update.topics
            if TF_MESSAGE in row.type_names and row.name not in FRAME_TOPICS and row.publishers
        },
        volatile=tuple(dict.fromkeys(volatile)),
        simulated=any(row.name == CLOCK and row.publishers for row in update.topics),
        settling=is_settling(update),
        most=MOST_FRAMES,
    )
