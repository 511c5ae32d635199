"""Gauge and map say near where the safety node does: by the distances that it tells of itself."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from tests.tui.app_runs import opened
from tests.tui.panel_stage import rows
from tests.tui.recorded import (
    RecordedGraph,
    RecordedOpener,
    lesson_samples,
    lesson_update,
    sample,
)
from tui.panels.sonar.bar import scale
from tui.panels.sonar.bounds import bounds_of
from tui.panels.sonar.widget import Sonar
from tui.panels.sonar.words import COURSE, Bounds, Zone, zone_of

if TYPE_CHECKING:
    from graph.data import GraphUpdate

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
        await pilot.pause()
        await pilot.pause()
        assert "CLOSE" in rows(gauge)[0]
        opener.graph.show(told(1.2, critical_m="0.3", slow_m="1.5"))
        await pilot.pause()
        await pilot.pause()
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


@pytest.mark.parametrize(
    ("slow_m", "zone"), [("1.5", Zone.STOP), ("0", Zone.CLOSE), ("0.7", Zone.CLOSE)]
)
def test_at_the_critical_distance_itself_it_says_what_the_gate_does(
    slow_m: str, zone: Zone
) -> None:
    bounds = bounds_of(told(critical_m="0.8", slow_m=slow_m), COURSE)
    assert zone_of(0.8, bounds) is zone
    assert "↑0.8" in "".join(ink.text for ink in scale(40, bounds))
