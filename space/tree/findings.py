"""All that is wrong with the frames, the worst first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from space.tree.finding import FrameFinding, FrameTrouble, listed
from space.tree.of_frames import findings_of_frames
from space.tree.of_tree import findings_of_tree
from text.ros_names import TF, TF_STATIC
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

    from space.tree.heard import HeardFrame
    from space.tree.tree import FrameTree


@dataclass(frozen=True)
class Surroundings:
    """What is known besides the frames themselves."""

    named: Mapping[str, str] = field(default_factory=dict)
    """Topic to the frame that the header of its newest message names."""
    elsewhere: Mapping[str, int] = field(default_factory=dict)
    """Other topics on which somebody publishes frames, to how many listen there."""
    volatile: tuple[str, ...] = ()
    """Nodes that publish /tf_static and do not latch it."""
    settling: bool = False
    """Whether static frames are still to come: what is missing now may be there in a moment."""
    simulated: bool = False
    """Whether somebody publishes /clock, so that stamps are not times of day."""
    most: int = 0
    """How many frames are kept at most; 0 without a limit."""


def frame_findings(tree: FrameTree, heard: Sequence[HeardFrame], around: Surroundings) -> list[FrameFinding]:
    """Return what is wrong, the worst first."""
    found = [
        *findings_of_tree(tree, around.named, settling=around.settling),
        *findings_of_frames(heard, simulated=around.simulated),
        *_full(heard, around),
        *_volatile(around),
        *_elsewhere(around),
    ]
    order = list(FrameTrouble)
    return sorted(found, key=lambda one: order.index(one.trouble))


def _full(heard: Sequence[HeardFrame], around: Surroundings) -> Iterator[FrameFinding]:
    if around.most and len(heard) >= around.most:
        text = say("there are more than {most} frames; the others are not shown", most=around.most)
        advice = say("look for a node that makes a new name each time, such as one with a number or a time in it")
        yield FrameFinding(FrameTrouble.FULL, (), text, advice)


def _volatile(around: Surroundings) -> Iterator[FrameFinding]:
    if around.volatile:
        text = say(
            "{nodes}: publishes {topic} without transient_local, so that tf2 does not hear it",
            nodes=listed(around.volatile),
            topic=TF_STATIC,
        )
        advice = say(
            "create its publisher with durability transient_local and depth 1, as "
            "tf2_ros.StaticTransformBroadcaster does"
        )
        yield FrameFinding(FrameTrouble.VOLATILE, (), text, advice)


def _elsewhere(around: Surroundings) -> Iterator[FrameFinding]:
    for topic, listeners in sorted(around.elsewhere.items()):
        text = (
            say("frames come on {topic} too, where tf2 does not listen by itself", topic=topic)
            if listeners
            else say("frames come on {topic} too, which nobody here listens to", topic=topic)
        )
        advice = say(
            "start its publisher with -r {topic}:={usual}, or whoever needs these frames with -r {usual}:={topic}",
            topic=topic,
            usual=TF_STATIC if topic.endswith(TF_STATIC) else TF,
        )
        yield FrameFinding(FrameTrouble.ELSEWHERE, (), text, advice)
