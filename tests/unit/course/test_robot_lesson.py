"""The check of the lesson on the robot that a word fits the distance, while the robot drives."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from course.judge.functions import SeenMessages, load
from course.lessons.catalog import SHIPPED

Distance = Callable[[float], float]
EVERY_S = 0.03
ASKED_S = (0.05, 0.65, 1.25, 1.85)
WAYS: dict[str, Distance] = {
    "away": lambda time: 0.97 + 0.5 * time,
    "toward": lambda time: 1.03 - 0.5 * time,
    "far": lambda _: 2.0,
    "near": lambda _: 0.6,
    "once in vain": lambda time: math.nan if 0.6 <= time < 0.6 + EVERY_S else 2.0,
    "in vain": lambda _: math.nan,
}
decides = load(SHIPPED / "robot", "checks.py:decides")


def seen(distance: Distance, late_s: float, *, right: bool) -> SeenMessages:
    """What comes of four voices to a brain that has heard of the distance so late."""
    distances = [(each, distance(each)) for each in (n * EVERY_S for n in range(80))]
    words = []
    for asked_s in ASKED_S:
        clear = distance(max(asked_s - late_s, 0.0)) >= 1.0
        words.append((asked_s + 0.02, "вперед" if clear == right else "стоп"))
    return SeenMessages(
        messages={
            "/sensor/sonar_front": [(time, {"data": value}) for time, value in distances],
            "/ai_command": [(time, {"data": word}) for time, word in words],
        },
        values={},
        logs={},
        logged={},
    )


@pytest.mark.parametrize("late_s", [0.0, 0.1, 0.4])
@pytest.mark.parametrize("way", WAYS)
def test_a_word_is_judged_where_it_can_be_told_which_is_right(way: str, late_s: float) -> None:
    """A measurement of just before or after must not excuse the wrong word, nor blame the right."""
    assert decides(seen(WAYS[way], late_s, right=True)) is None
    assert decides(seen(WAYS[way], late_s, right=False)) is not None


def test_where_the_sonar_says_both_nothing_is_proven() -> None:
    def to_and_fro(time: float) -> float:
        return 0.99 if round(time / EVERY_S) % 2 else 1.01

    for right in (True, False):
        assert "not clear" in str(decides(seen(to_and_fro, 0.0, right=right)))
