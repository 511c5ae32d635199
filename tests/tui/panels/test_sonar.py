"""The sonar gauge: metres, a word for what they mean, how it has been, and why there is nothing."""

from __future__ import annotations

import math
from typing import Any

import pytest

from graph.data import Trouble
from tests.tui.panel_stage import alone, rows
from tui.panels.sonar.bar import bar, mark_cell, trend
from tui.panels.sonar.widget import Sonar, SonarView
from tui.panels.sonar.words import COURSE, Zone, zone_of

INF, NAN = math.inf, math.nan


@pytest.mark.parametrize(
    ("metres", "zone"),
    [
        (0.49, Zone.STOP),
        (0.5, Zone.CLOSE),
        (0.99, Zone.CLOSE),
        (1.0, Zone.FREE),
        (INF, Zone.FREE),
        (-INF, Zone.STOP),
        (-1.0, Zone.STOP),
        (NAN, Zone.BLIND),
    ],
)
def test_a_distance_means_free_close_stop_or_blind(metres: float, zone: Zone) -> None:
    assert zone_of(metres) is zone


@pytest.mark.parametrize(
    ("metres", "words"),
    [
        (1.836, ("1.84 m", "FREE")),
        (0.72, ("0.72 m", "CLOSE")),
        (0.38, ("0.38 m", "STOP")),
        (INF, ("nothing in range", "FREE")),
        (-INF, ("too close to measure", "STOP")),
        (NAN, ("no valid reading", "BLIND")),
        (-2.0, ("impossible", "STOP")),
    ],
)
@pytest.mark.parametrize("height", [1, 2, 4])
async def test_a_small_gauge_says_number_and_word(
    metres: float, words: tuple[str, str], height: int
) -> None:
    gauge = Sonar("front")
    async with alone(gauge, 44, height).run_test(size=(60, 20)):
        gauge.show(metres, 0.0)
        shown = rows(gauge)[0]
        assert all(word in shown for word in ("front", *words))


@pytest.mark.parametrize("width", [6, 20, 33, 80])
def test_the_bar_is_as_long_as_the_distance_and_marks_the_threshold(width: int) -> None:
    for metres in (0.0, 0.3, 0.5, 1.7, 3.0, 9.0, INF, NAN, -1.0):
        assert sum(len(ink.text) for ink in bar(metres, width, COURSE)) == width
    filled, rest = bar(0.0, width, COURSE)
    assert filled.text == ""
    assert rest.text[mark_cell(0.5, width)] == "│"
    assert rest.text[mark_cell(1.0, width)] == "│"
    assert len(bar(1.5, 30, COURSE)[0].text) == 15


def test_the_trend_has_the_newest_at_the_right() -> None:
    (line,) = trend([3.0, NAN, 0.0], 5, 1, COURSE)
    assert "".join(ink.text for ink in line) == "  █?▁"


async def test_silence_is_told_with_its_length_and_old_values_are_greyed() -> None:
    gauge = Sonar("front")
    async with alone(gauge, 40, 8).run_test(size=(60, 20)):
        gauge.show(0.38, 0.0)
        gauge.show_trouble(Trouble.QUIET, "", 3.4)
        assert "no data for 3 s" in rows(gauge)[0]
        assert "STOP" not in rows(gauge)[0]
        looks = {ink.look for line in gauge._lines for ink in line if ink.text.strip()}
        assert looks == {"muted", "alert"}
        gauge.show_trouble(None)
        assert "STOP" in rows(gauge)[0]


@pytest.mark.parametrize(
    ("trouble", "words"),
    [
        (None, "waiting for the first message"),
        (Trouble.NO_PUBLISHER, "nobody publishes this topic"),
        (Trouble.QOS_MISMATCH, "QoS is incompatible"),
        (Trouble.UNKNOWN_TYPE, "message type is not installed"),
        (Trouble.QUIET, "there is a publisher, but no message has arrived yet"),
    ],
)
async def test_an_empty_gauge_says_why(trouble: Trouble | None, words: str) -> None:
    gauge = Sonar("front")
    async with alone(gauge, 50, 4).run_test(size=(60, 20)):
        gauge.show_trouble(trouble, "[b]detail[/b]\x1b[31m")
        shown = " ".join(" ".join(rows(gauge)).split())
        assert words in shown
        assert "[b]detail[/b]␛[31m" in shown


async def test_the_same_again_draws_nothing() -> None:
    gauge = Sonar("front")
    async with alone(gauge, 40, 4).run_test(size=(60, 20)):
        gauge.show_trouble(None, "", 0.1)
        for second in range(60):
            gauge.show(1.0, float(second))
        asked: list[Any] = []

        def note(*regions: Any, **_more: Any) -> Sonar:
            asked.extend(regions)
            return gauge

        gauge.refresh = note  # type: ignore[method-assign]
        gauge.show(1.0, 60.0)
        assert asked == []
        gauge.show(1.1, 61.0)
        assert sum(region.area for region in asked) < 40


async def test_the_rear_gauge_comes_only_when_there_is_one() -> None:
    view = SonarView()
    async with alone(view, 40, 16).run_test(size=(60, 30)) as pilot:
        view.show("front", 1.5, 0.0)
        rear = view.query_one("#rear", Sonar)
        assert not rear.display
        view.set_both(True)
        view.show("rear", 0.4, 0.0)
        await pilot.pause()
        assert "rear" in rows(rear)[0]
        assert "STOP" in rows(rear)[0]
