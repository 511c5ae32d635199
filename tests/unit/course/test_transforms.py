"""What the judge makes of transforms."""

from __future__ import annotations

import math
from typing import Any, cast

import pytest

from course.judge.evidence import Evidence
from course.judge.transforms import transform
from graph.data import Sample
from launcher.profile.steps.checks import TransformCheck
from tests.unit.transform_messages import Sent

TYPE = "tf2_msgs/msg/TFMessage"


class Heard:
    """The part of the evidence that this check uses."""

    def __init__(self, *sent: Sent) -> None:
        self.tree = {"transforms": [tree_of(one) for one in sent]}

    def fresh_s(self, _topic: str, *, latched: bool) -> float:
        return math.inf if latched else 1.0

    def messages(self, topic: str, _fresh_s: float) -> list[Sample]:
        latched = topic == "/tf_static"
        return [Sample(topic, TYPE, 0.0, 0.0, 0, self.tree)] if latched else []


def tree_of(one: Sent) -> dict[str, Any]:
    return {
        "header": {"frame_id": one.parent},
        "child_frame_id": one.child,
        "transform": {
            "translation": dict(zip("xyz", one.translation, strict=True)),
            "rotation": dict(zip("xyzw", one.rotation, strict=True)),
        },
    }


def judged(*sent: Sent) -> tuple[bool, str]:
    asked = TransformCheck.model_validate(
        {
            "transform": {"from": "base_link", "to": "camera_link"},
            "translation": [0.15, 0.0, 0.25],
            "rotation_rpy": [0.0, 0.0, math.pi / 2],
        }
    )
    found = transform(asked, cast("Evidence", Heard(*sent)), 0.0)
    return found.met, str(found.seen)


HALF = math.sqrt(0.5)
LEFT = (0.0, 0.0, HALF, HALF)


def test_a_way_over_other_frames_counts() -> None:
    mast = Sent("base_link", "mast", 0.0, (0.15, 0.0, 0.0))
    camera = Sent("mast", "camera_link", 0.0, (0.0, 0.0, 0.25), LEFT)
    assert judged(mast, camera)[0]


def test_the_way_back_counts_too() -> None:
    # Where base_link is, seen from a camera that looks to the left.
    assert judged(Sent("camera_link", "base_link", 0.0, (0.0, 0.15, -0.25), (0, 0, -HALF, HALF)))[0]


@pytest.mark.parametrize(
    ("translation", "rotation", "words"),
    [
        ((0.15, 0.0, 0.20), LEFT, "the translation is 0.150, 0.000, 0.200 m"),
        ((0.15, 0.0, 0.25), (0.0, 0.0, 0.0, 1.0), "the rotation is 0.000, 0.000, 0.000 rad"),
        ((math.nan, 0.0, 0.25), LEFT, "the numbers of camera_link are no place"),
        ((0.15, 0.0, 0.25), (0.0, 0.0, 0.0, 0.0), "the numbers of camera_link are no place"),
    ],
)
def test_what_is_elsewhere_or_nowhere_is_told(
    translation: tuple[float, float, float],
    rotation: tuple[float, float, float, float],
    words: str,
) -> None:
    met, seen = judged(Sent("base_link", "camera_link", 0.0, translation, rotation))
    assert not met
    assert seen.startswith(words)


def test_two_trees_are_told() -> None:
    met, seen = judged(Sent("base_link", "mast"), Sent("world", "camera_link"))
    assert (met, seen) == (False, "base_link and camera_link are not connected")
