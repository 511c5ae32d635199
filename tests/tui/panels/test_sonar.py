"""The sonar gauge: metres, a word for what they mean, how it has been, and why there is nothing."""

from __future__ import annotations

import math
from typing import Any

import pytest

from graph.data import Trouble
from tests.tui.panel_stage import Stage, alone, rows
from tests.tui.snapshots import SnapCompare
from text.i18n import set_language
from tui.panels.sonar.bar import bar, mark_cell, trend
from tui.panels.sonar.widget import Sonar, SonarView
from tui.panels.sonar.words import COURSE, Bounds, Zone, zone_of

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


async def test_the_bounds_can_be_others() -> None:
    gauge = Sonar("front")
    async with alone(gauge, 44, 3).run_test(size=(60, 20)):
        gauge.show(0.7, 0.0)
        assert "CLOSE" in rows(gauge)[0]
        gauge.set_bounds(Bounds(0.8, 2.0))
        assert "STOP" in rows(gauge)[0]
        gauge.show(1.7, 1.0)
        assert "CLOSE" in rows(gauge)[0]


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


async def test_a_trend_tells_how_far_back_it_reaches() -> None:
    gauge = Sonar("front")
    async with alone(gauge, 30, 14).run_test(size=(60, 20)):
        for second in range(100):
            gauge.show(1.0, float(second))
        assert any("last 29 s" in row for row in rows(gauge))


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


@pytest.mark.parametrize("size", [(1, 1), (3, 2), (7, 5), (120, 50)])
async def test_any_size_is_drawn(size: tuple[int, int]) -> None:
    gauge = Sonar("front")
    async with alone(gauge, *size).run_test(size=(130, 60)):
        for metres in (1.0, NAN, INF, -INF, 1e300, 0.001):
            gauge.show(metres, 0.0)
            assert len(rows(gauge)) == size[1]


@pytest.mark.parametrize("language", ["en", "ru"])
def test_looks(language: str, snap_compare: SnapCompare) -> None:
    """FREE, CLOSE, STOP and BLIND by word and colour; a stale gauge is grey; small ones fit."""
    set_language(language)
    gauges = [Sonar("front") for _gauge in range(9)]

    def fill() -> None:
        history = [0.3 + 2.7 * abs(math.sin(second / 5)) for second in range(60)]
        history[45], history[50] = INF, NAN
        last = (1.84, 0.72, 0.38, INF, NAN, 1.2, 0.44, 5.0)
        for gauge, metres in zip(gauges, last, strict=False):
            for second, value in enumerate((*history, metres)):
                gauge.show(value, float(second))
        gauges[5].show_trouble(Trouble.QUIET, "", 3.4)
        gauges[8].show_trouble(Trouble.NO_PUBLISHER, "Start sonar_front.")

    stage = Stage(
        [(gauges[0], (34, 12)), (gauges[1], (34, 7)), (gauges[2], (34, 4)), (gauges[3], (34, 3))],
        [(gauges[4], (38, 8)), (gauges[5], (38, 8)), (gauges[6], (38, 1)), (gauges[8], (38, 4))],
        [(gauges[7], (20, 16))],
        fill=fill,
    )
    assert snap_compare(stage, terminal_size=(102, 36), run_before=stage.filled)
