"""Publishing at a rate: what is due goes out, nothing drifts, what is long past is let go."""

from __future__ import annotations

from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.publishing.publications import LATE_S, _Repeated
from graph.qos import RELIABLE, VOLATILE, Qos


class Publisher:
    """Counts what is published; fails when it is told to."""

    def __init__(self) -> None:
        self.published: list[bytes] = []
        self.fails = False

    def publish(self, raw: bytes) -> None:
        if self.fails:
            raise RuntimeError("the middleware is full")
        self.published.append(raw)

    def get_subscription_count(self) -> int:
        return 3


def repeated(hz: float, publisher: Publisher) -> _Repeated:
    return _Repeated(
        1, "/t", "a/msg/B", hz, b"raw", object, Qos(RELIABLE, VOLATILE), cast("Any", publisher), 0.0
    )


@given(st.floats(0.1, 100), st.lists(st.floats(0, LATE_S / 2), max_size=200))
def test_the_mean_rate_is_exact_however_late_each_step_comes(
    hz: float, pauses: list[float]
) -> None:
    publisher = Publisher()
    one, now_s = repeated(hz, publisher), 0.0
    one.step(now_s)
    for pause_s in pauses:
        now_s += pause_s
        one.step(now_s)
    assert len(publisher.published) == pytest.approx(now_s * hz + 1, abs=1.001)
    assert one.due_s > now_s
    assert one.row().sent == len(publisher.published)


def test_what_was_slept_through_is_not_made_up_for() -> None:
    publisher = Publisher()
    one = repeated(10.0, publisher)
    one.step(0.0)
    one.step(60.0)
    assert len(publisher.published) == 2
    assert one.due_s == pytest.approx(60.1)


def test_what_cannot_be_published_ends_and_says_why() -> None:
    publisher = Publisher()
    one = repeated(10.0, publisher)
    one.step(0.0)
    publisher.fails = True
    one.step(0.1)
    row = one.row()
    assert (row.sent, row.error, row.subscribers) == (1, "the middleware is full", 3)
