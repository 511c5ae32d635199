"""The Devices screen: every driver, its frames, why nothing comes; and trouble of a simulation."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Static

from graph.data import NodeRow, ParameterRow, ParametersResult, Sample
from graph.observer.requests import SetParameters
from launcher.status import NodeState, NodeStatus
from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_devices import AT_S, STATUSES, of_chassis, status, update, with_drivers
from tests.tui.screen_stage import ScreenStage, on_stage
from tests.tui.snapshots import opened, settle
from tests.waiting import until
from tui import clock
from tui.actions import REGISTRY
from tui.app import DeckApp
from tui.devices.diagnostics import DiagnosticsView
from tui.devices.screen import DevicesScreen


class DevicesStage(ScreenStage[DevicesScreen]):
    """The screen with its recorded drivers."""

    name, kind = "devices", DevicesScreen

    async def hear(self, *samples: Sample) -> None:
        await self.show(update(*samples))

    def drivers(self) -> list[str]:
        """The rows of the table, without blanks at the ends."""
        table = self.screen.table
        height = table.size.height
        return [row for y in range(1, height) if (row := table.render_line(y).text.strip())]

    def lines(self) -> list[str]:
        return [entry.text for entry in self.screen.pane.view.index.shown]

    def whole(self) -> str:
        return str(self.screen.query_one("#devices-chosen", Static).render())


def stage(of: RecordedOpener | None = None) -> AbstractAsyncContextManager[DevicesStage]:
    return on_stage(DevicesStage, of or with_drivers())


async def test_every_driver_has_a_row_though_all_speak_on_one_topic() -> None:
    async with stage() as at:
        rows = at.drivers()
        assert [row.removeprefix("▶ ").split("  ")[0] for row in rows] == [
            "chassis", "imu: data", "sonar_front", "sonar_rear",
        ]  # fmt: skip
        assert "▲ warning" in rows[0]
        assert "1\N{NO-BREAK SPACE}290" in rows[0]
        assert "✗ error" in rows[3]
        assert "no link" in rows[3]
        await at.hear(status("sonar_rear", 0, "back again"))
        assert "back again" in at.drivers()[3]
        assert "The wheels stand" in at.drivers()[0]


async def test_frames_both_ways_with_noise_and_a_bad_one() -> None:
    async with stage() as at:
        await at.hear(of_chassis())
        lines = at.lines()
        assert len(lines) == 17
        assert lines[0].split("  ")[0].startswith("drive left 3.20 right 3.40 rad/s")
        assert lines[0].endswith("$D,17,3200,3400,100*3CC7")
        assert lines[9].startswith("~ noise 2 bytes")
        assert lines[10].startswith("✗ CRC FAILED")
        await at.press("v")
        assert at.lines()[0].endswith("33 43 43 37 0A")
        assert at.lines()[9].endswith("FF 00")
        await at.press("v")
        assert at.lines() == lines
        await at.press("f9")
        await at.pilot.pause()
        assert "▲ внимание" in at.whole()
        assert {entry.node for entry in at.screen.pane.view.index.shown} == {"← вх", "→ исх"}


async def test_why_nothing_comes_from_a_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    async with stage() as at:
        view = at.screen.pane.view
        assert "Listening on /chassis/frames" in view.empty_words
        await at.press("down")
        assert "does not publish …/imu: data/frames" in view.empty_words
        await at.press("end")
        assert "Nothing is connected" in view.empty_words
        assert "no such port; plug it in" in at.whole()
        await at.press("home")
        monkeypatch.setattr(clock, "now", lambda: AT_S + 5.0)
        await at.hear(status("sonar_front"))
        rows = at.drivers()
        assert "○ stale 5 s" in rows[0]
        assert "chassis has said nothing for 5 s" in at.screen.pane.view.empty_words
        await at.press("1", "7")
        assert "▲ warning" in at.drivers()[0], "nobody listened in between"


async def test_the_second_tab_has_what_everybody_says_the_worst_on_top() -> None:
    async with stage() as at:
        await at.press("right")
        view = at.screen.query_one(DiagnosticsView)
        assert at.screen.focused is view.names
        first, second, *_ = (row.cells[0].text for row in view.names._rows)
        assert first.startswith("✗ sonar_rear  Cannot open ")
        assert second == "▲ chassis  The wheels stand: no drive line for 250 ms"
        # The frames of a driver are not asked for while nobody sees them.
        assert at.graph.wanted.followed >= {"/diagnostics"}
        assert not any("frames" in topic for topic in at.graph.wanted.followed)
        await at.press("left")
        assert not at.screen.shows_tree
        assert any("frames" in topic for topic in at.graph.wanted.followed)


MOCK = "/mock_robot"
TROUBLES = ("devices.unplug", "devices.noise", "devices.silence", "devices.battery")


def simulation(*samples: Any) -> tuple[RecordedOpener, RecordedGraph]:
    """Drivers at the lines of a simulated robot, whose node has its parameters."""
    drivers = with_drivers()
    graph = RecordedGraph(with_robot(*(samples or STATUSES)))
    lines = [ParameterRow(name, "string", "fine") for name in ("pico", "tof_front", "tof_rear")]
    rows = (*lines, ParameterRow("battery", "double", 7.4))
    graph.node_parameters[MOCK] = ParametersResult(MOCK, rows)
    robot = NodeStatus("mock_robot", "nodes.mock_robot", NodeState.READY, pid=4199, roles=("simulator",))
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
        ("Z", "chassis", "pico", "noise", "fine", "pico: the noise is gone"),
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
        assert [asked[:2] for asked in graph.asked(SetParameters)] == [
            (MOCK, {parameter: wrong}),
            (MOCK, {parameter: fine}),
        ]
        assert told(app)[1].startswith(over)


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
