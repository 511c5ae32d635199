"""The check of a transform between two frames, from what /tf and /tf_static have said.

Transforms are chained as tf2 does (REP-105): from each frame up to their common ancestor.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from course.judge.evidence import MET, Observation
from robot.topics import TF, TF_STATIC
from space.buffer import NoTransformError, Stamped, TransformBuffer
from space.transform import Transform
from text.sentences import say
from text.suggestions import nearest

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.judge.evidence import Evidence
    from launcher.profile.steps.checks import TransformCheck

TOPICS = (TF_STATIC, TF)
TYPE = "tf2_msgs/msg/TFMessage"


def transform(check: TransformCheck, evidence: Evidence, _since_s: float) -> Observation:
    """There is a transform between two frames, by so much."""
    base, target = check.transform.from_frame, check.transform.to
    buffer, invalid = TransformBuffer(), set[str]()
    for each in _transforms(evidence):
        place = _placed(each)
        if place is None:
            invalid.add(each["child_frame_id"])
        else:
            buffer.add([place])
    unknown = [frame for frame in (base, target) if frame not in buffer.frames]
    for frame in unknown:
        if frame in invalid:
            seen = say("the numbers of {frame} are no place: nan, inf, or a quaternion of zeros", frame=frame)
            return Observation(met=False, seen=seen)
    if unknown:
        return Observation(met=False, seen=_unknown(unknown[0], buffer.frames))
    try:
        found = buffer.find(base, target)
    except NoTransformError:
        return Observation(met=False, seen=say("{a} and {b} are not connected", a=base, b=target))
    return _compared(check, found)


def _unknown(frame: str, known: frozenset[str]) -> str:
    meant = nearest(frame, known)
    if meant:
        return say("nobody publishes the frame {frame}, but {meant}", frame=frame, meant=meant)
    return say("nobody publishes the frame {frame}", frame=frame)


def _compared(check: TransformCheck, found: Transform) -> Observation:
    moved, turned = found.translation, found.rpy_rad
    for wanted, got, words in (
        (check.translation, moved, say("the translation is {value} m")),
        (check.rotation_rpy, turned, say("the rotation is {value} rad")),
    ):
        if wanted is not None and any(
            abs(_wrapped(a - b) if got is turned else a - b) > check.tolerance
            for a, b in zip(wanted, got, strict=True)
        ):
            value = ", ".join(f"{each:.3f}" for each in got)
            return Observation(met=False, seen=say(words.template, value=value))
    return MET


def _wrapped(angle: float) -> float:
    return math.remainder(angle, math.tau)


def _transforms(evidence: Evidence) -> Iterator[Any]:
    """Yield every transform that has come, as the tree of a TransformStamped."""
    for topic in TOPICS:
        fresh_s = evidence.fresh_s(topic, latched=topic == TF_STATIC)
        for message in evidence.messages(topic, fresh_s):
            if message.type_name == TYPE:
                yield from message.value["transforms"]  # type: ignore[misc]


def _placed(each: Any) -> Stamped | None:  # noqa: ANN401 - a TransformStamped
    """Return where a frame is, for all times, as the newest counts; None for invalid numbers."""
    moved, turned = each["transform"]["translation"], each["transform"]["rotation"]
    try:
        place = Transform.of(
            (moved["x"], moved["y"], moved["z"]), (turned["x"], turned["y"], turned["z"], turned["w"])
        )
    except ValueError:
        return None
    return Stamped(each["header"]["frame_id"], each["child_frame_id"], 0.0, place, static=True)
