"""The check of lesson 3 that the head goes on telling where it looks while it turns."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import pytest

from course.judge.functions import SeenMessages, load
from course.lessons.catalog import SHIPPED

never_silent = load(SHIPPED / "03-head-service", "checks.py:never_silent")
TICKS_S = [each * 0.1 for each in range(200)]


def seen(ticks_s: Iterable[float], there_s: float) -> SeenMessages:
    """What is told of a head that is at the fourth tilt from this moment on."""
    states: list[tuple[float, Mapping[str, Any]]] = [
        (time_s, {"position": [0.0, math.radians(4 if time_s >= there_s else 3)]}) for time_s in ticks_s
    ]
    return SeenMessages(messages={"/head_state": states}, values={}, logs={}, logged={})


@pytest.mark.parametrize(
    ("silent_s", "right"),
    [
        ((0.0, 0.0), True),
        ((1.0, 12.6), True),  # Long before it turned: it was suspended, or nobody listened.
        ((16.2, 18.0), True),  # After it had turned.
        ((14.9, 16.0), False),  # As long as a turn takes: nothing else is done meanwhile.
        ((15.3, 16.0), True),
    ],
)
def test_only_silence_during_the_movement_counts(silent_s: tuple[float, float], right: bool) -> None:
    began_s, ended_s = silent_s
    told = never_silent(seen((t for t in TICKS_S if not began_s < t < ended_s - 0.01), 16.0))
    assert (told is None) is right, told
