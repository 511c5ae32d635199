"""The sonar gauge: metres, a word for what they mean, how it has been, and why there is nothing."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest

from graph.data import GraphUpdate, Trouble
from tests.tui.panel_stage import alone, rows
from tests.tui.recorded import RecordedGraph, RecordedOpener, lesson_samples, lesson_update, sample
from tests.tui.snapshots import opened, settle
from text.i18n import set_language
from tui.panels.sonar import COURSE, Bounds, Sonar, Zone, bounds_of, zone_of

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


async def test_a_small_gauge_says_number_and_word() -> None:
    gauge = Sonar("front")
    async with alone(gauge, 44, 1).run_test(size=(60, 20)):
        for metres, words in (
            (1.836, ("1.84 m", "FREE")),
            (0.72, ("0.72 m", "CLOSE")),
            (0.38, ("0.38 m", "STOP")),
            (INF, ("nothing in range", "FREE")),
            (-INF, ("too close to measure", "STOP")),
            (NAN, ("no valid reading", "BLIND")),
            (-2.0, ("impossible", "STOP")),
        ):
            gauge.show(metres, 0.0)
            assert all(word in rows(gauge)[0] for word in ("front", *words))


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


async def test_an_empty_gauge_says_why() -> None:
    gauge = Sonar("front")
    async with alone(gauge, 50, 4).run_test(size=(60, 20)):
        for trouble, words in (
            (None, "waiting for the first message"),
            (Trouble.NO_PUBLISHER, "nobody publishes this topic"),
            (Trouble.QOS_MISMATCH, "QoS is incompatible"),
            (Trouble.UNKNOWN_TYPE, "unknown type: the message type is not installed"),
            (Trouble.QUIET, "no message has arrived yet, though there is a publisher"),
        ):
            gauge.show_trouble(trouble, "detail")
            shown = " ".join(" ".join(rows(gauge)).split())
            assert words in shown
            assert "detail" in shown


SAFETY, FRONT = "/safety_state", "/sensor/sonar_front"


def told(metres: float = 0.7, **values: str) -> GraphUpdate:
    """The lesson with a sonar at so many metres and these values of the safety node."""
    pairs = [{"key": key, "value": value} for key, value in {"verdict": "free", **values}.items()]
    status = [{"level": b"\x00", "name": "safety_stop", "message": "", "values": pairs}]
    own = {
        FRONT: (sample(FRONT, "std_msgs/msg/Float32", {"data": metres}),),
        SAFETY: (sample(SAFETY, "diagnostic_msgs/msg/DiagnosticArray", {"status": status}),),
    }
    return lesson_update(samples={**lesson_samples(), **own})


async def test_the_gauge_stops_where_the_safety_node_does() -> None:
    opener = RecordedOpener(graph=RecordedGraph(told(critical_m="0.8", slow_m="1.5")))
    async with opened(opener) as (app, pilot):
        await pilot.pause()
        gauge = app.screen.query_one("#front", Sonar)
        assert "STOP" in rows(gauge)[0]
        # Somebody sets critical_distance while it runs.
        opener.graph.show(told(critical_m="0.3", slow_m="1.5"))
        await settle(pilot)
        assert "CLOSE" in rows(gauge)[0]


@pytest.mark.parametrize(
    ("values", "bounds"),
    [
        ({"critical_m": "0.8", "slow_m": "1.5"}, Bounds(math.nextafter(0.8, 1.0), 1.5)),
        ({"critical_m": "0.3", "slow_m": "0"}, Bounds(0.3, 1.0)),
        ({"critical_m": "1.3", "slow_m": "0.5"}, Bounds(1.3, 1.3)),
        ({"critical_m": "0.8"}, Bounds(0.8, 1.0)),
        ({}, COURSE),
        ({"critical_m": "nan", "slow_m": "1.5"}, COURSE),
        ({"critical_m": "-1", "slow_m": "inf"}, COURSE),
        ({"critical_m": "near"}, COURSE),
    ],
)
def test_bounds_are_those_that_the_node_tells(values: dict[str, Any], bounds: Bounds) -> None:
    assert bounds_of(told(**values), COURSE) == bounds


@pytest.mark.parametrize("language", ["en", "ru"])
@pytest.mark.parametrize("trouble", [Trouble.NO_PUBLISHER, Trouble.QOS_MISMATCH, Trouble.UNKNOWN_TYPE, Trouble.QUIET])
async def test_what_is_cut_does_not_say_the_opposite(trouble: Trouble, language: str) -> None:
    set_language(language)
    gauge = Sonar("front")
    async with alone(gauge, 16, 1).run_test(size=(60, 20)):
        gauge.show_trouble(trouble)
        (row,) = rows(gauge)
        assert re.search("^ *(no |nobody |unknown |QoS |ни |неизвестный |никто )", row), row
        assert row.endswith("…")
