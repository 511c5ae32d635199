"""Trouble of the simulated robot, made and mended on the Devices screen."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot

from graph.data import NodeRow, ParameterRow, ParametersResult
from launcher.status import NodeState, NodeStatus
from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_devices import STATUSES, status, update, with_drivers
from tests.tui.snapshots import settle
from tests.waiting import until
from tui.actions import REGISTRY
from tui.app import DeckApp
from tui.devices.screen import DevicesScreen

MOCK = "/mock_robot"
TROUBLES = ("devices.unplug", "devices.noise", "devices.silence", "devices.battery")


def simulation(*samples: Any) -> tuple[RecordedOpener, RecordedGraph]:
    """Drivers at the lines of a simulated robot, whose node has its parameters."""
    drivers = with_drivers()
    graph = RecordedGraph(with_robot(*(samples or STATUSES)))
    lines = [ParameterRow(name, "string", "fine") for name in ("pico", "tof_front", "tof_rear")]
    rows = (*lines, ParameterRow("battery", "double", 7.4))
    graph.node_parameters[MOCK] = ParametersResult(MOCK, rows)
    robot = NodeStatus("mock_robot", "nodes.mock_robot", NodeState.READY, pid=4199)
    link: Any = drivers.link
    link.nodes["mock_robot"] = robot
    return RecordedOpener(link, graph), graph


def with_robot(*samples: Any) -> Any:
    now = update(*samples)
    return replace(now, nodes=(*now.nodes, NodeRow(MOCK)))


def possible(app: DeckApp) -> list[str]:
    return [name for name in TROUBLES if REGISTRY[name].possible(app.screen)]


async def choose(app: DeckApp, pilot: Pilot[Any], name: str) -> None:
    assert isinstance(app.screen, DevicesScreen)
    app.screen.table.choose(name)
    await pilot.pause()


def told(app: DeckApp) -> list[str]:
    return [note.message for note in app._notifications]


@pytest.mark.parametrize(
    ("key", "driver", "parameter", "wrong", "fine", "over"),
    [
        ("U", "sonar_front", "tof_front", "unplugged", "fine", "tof_front: the cable is plugged"),
        ("Г", "sonar_rear", "tof_rear", "unplugged", "fine", "tof_rear: the cable is plugged"),
        ("Z", "chassis", "pico", "noise", "fine", "pico: the noise is gone"),
        ("H", "sonar_front", "tof_front", "silent", "fine", "tof_front: it sends data again"),
        ("B", "chassis", "battery", 5.8, 7.4, "The battery has 7.4 V"),
    ],
)
async def test_a_key_makes_the_trouble_and_mends_it(
    key: str, driver: str, parameter: str, wrong: str | float, fine: str | float, over: str
) -> None:
    """Mended is told of this trouble only: a low battery does not mend a pulled cable."""
    recorded, graph = simulation()
    async with opened(recorded, "devices") as (app, pilot):
        await choose(app, pilot, driver)
        await pilot.press(key)
        await until(lambda: len(told(app)) == 1, "the word of the trouble")
        await pilot.press(key)
        await until(lambda: len(told(app)) == 2, "the word that it is mended")
        assert graph.set_to == [(MOCK, {parameter: wrong}), (MOCK, {parameter: fine})]
        assert told(app)[1].startswith(over)


async def test_what_the_robot_refuses_is_told() -> None:
    recorded, graph = simulation()
    graph.refusals = {"tof_front": "the port is gone"}
    async with opened(recorded, "devices") as (app, pilot):
        await choose(app, pilot, "sonar_front")
        await pilot.press("U")
        await until(lambda: told(app) == ["the port is gone"], "the reason")


async def test_only_a_device_that_is_simulated_can_have_trouble_made() -> None:
    recorded, graph = simulation()
    async with opened(recorded, "devices") as (app, pilot):
        await choose(app, pilot, "chassis")
        assert possible(app) == list(TROUBLES)
        await choose(app, pilot, "sonar_front")
        assert "devices.battery" not in possible(app)
        await choose(app, pilot, "imu: data")
        assert possible(app) == []
        graph.show(with_robot(status("chassis", port="/dev/pico")))
        await settle(pilot)
        await choose(app, pilot, "chassis")
        assert possible(app) == []
