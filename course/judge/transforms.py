"""The check of a transform between two frames, from what /tf and /tf_static have said.

Transforms are chained as tf2 does (REP-105): from each frame up to their common ancestor.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from course.judge.evidence import MET, Observation
from robot.topics import TF, TF_STATIC
from text.sentences import say
from text.suggestions import nearest

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.judge.evidence import Evidence
    from launcher.profile.steps.checks import TransformCheck

TOPICS = (TF_STATIC, TF)
TYPE = "tf2_msgs/msg/TFMessage"

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
"""x, y, z, w."""


def transform(check: TransformCheck, evidence: Evidence, _since_s: float) -> Observation:
    """There is a transform between two frames, by so much."""
    parents = _parents(evidence)
    known = {*parents, *(parent for parent, _, _ in parents.values())}
    for frame in (check.transform.from_frame, check.transform.to):
        if frame not in known:
            meant = nearest(frame, known)
            seen = say("nobody publishes the frame {frame}", frame=frame)
            if meant:
                seen = say(
                    "nobody publishes the frame {frame}, but {meant}", frame=frame, meant=meant
                )
            return Observation(met=False, seen=seen)
    found = _between(check.transform.from_frame, check.transform.to, parents)
    if found is None:
        return Observation(
            met=False,
            seen=say(
                "{a} and {b} are not connected", a=check.transform.from_frame, b=check.transform.to
            ),
        )
    moved, turned = found
    return _compared(check, moved, _roll_pitch_yaw(turned))


def _compared(check: TransformCheck, moved: Vector, turned: Vector) -> Observation:
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


Parents = dict[str, tuple[str, Vector, Quaternion]]


def _parents(evidence: Evidence) -> Parents:
    parents: Parents = {}
    for topic in TOPICS:
        for message in evidence.messages(
            topic, evidence.fresh_s(topic, latched=topic == TF_STATIC)
        ):
            if message.type_name != TYPE:
                continue
            for each in message.value["transforms"]:  # type: ignore[union-attr]
                parents[each["child_frame_id"]] = _placed(each)  # type: ignore[index,call-overload]
    return parents


def _placed(each: Any) -> tuple[str, Vector, Quaternion]:  # noqa: ANN401 - a TransformStamped
    moved, turned = each["transform"]["translation"], each["transform"]["rotation"]
    return (
        each["header"]["frame_id"],
        (moved["x"], moved["y"], moved["z"]),
        (turned["x"], turned["y"], turned["z"], turned["w"]),
    )


def _between(
    base: str, target: str, parents: Mapping[str, Any]
) -> tuple[Vector, Quaternion] | None:
    """Return where `target` is, seen from `base`; None if they are not connected."""
    up_base, up_target = _upwards(base, parents), _upwards(target, parents)
    common = next((frame for frame in up_target if frame in up_base), None)
    if common is None:
        return None
    (base_moved, base_turned), (moved, turned) = up_base[common], up_target[common]
    back = _conjugate(base_turned)
    difference = (moved[0] - base_moved[0], moved[1] - base_moved[1], moved[2] - base_moved[2])
    return _rotated(back, difference), _times(back, turned)


def _upwards(frame: str, parents: Mapping[str, Any]) -> dict[str, tuple[Vector, Quaternion]]:
    """Return where a frame is, seen from itself and each of its ancestors."""
    at: dict[str, tuple[Vector, Quaternion]] = {frame: ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))}
    moved, turned = at[frame]
    while frame in parents:
        frame, step, turn = parents[frame]
        if frame in at:
            break
        x, y, z = _rotated(turn, moved)
        moved, turned = (x + step[0], y + step[1], z + step[2]), _times(turn, turned)
        at[frame] = moved, turned
    return at


def _times(a: Quaternion, b: Quaternion) -> Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def _conjugate(a: Quaternion) -> Quaternion:
    return (-a[0], -a[1], -a[2], a[3])


def _rotated(a: Quaternion, v: Vector) -> Vector:
    x, y, z, _w = _times(_times(a, (*v, 0.0)), _conjugate(a))
    return (x, y, z)


def _roll_pitch_yaw(a: Quaternion) -> Vector:
    x, y, z, w = a
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    return roll, pitch, math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
