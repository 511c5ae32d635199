"""The map on the screen: what it shows of a robot on its way, and why it shows nothing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from textual.app import App, ComposeResult

from graph.data import GraphUpdate, Trouble
from robot.motion.odometry import Pose
from tests.tui.panel_stage import rows
from tests.tui.recorded_map import (
    NOBODY,
    map_update,
    odometry,
    reading,
    stamped,
)
from tui.panels.map.panel import MapPanel
from tui.panels.map.widget import RoomMap


class Alone(App[None]):
    """The panel, and nothing else."""

    def compose(self) -> ComposeResult:
        """The panel."""
        yield MapPanel()

    def tell(self, *updates: GraphUpdate) -> str:
        """Show updates; return what stands on the panel then."""
        for update in updates:
            self.query_one(MapPanel).show(update)
        return self.text

    @property
    def text(self) -> str:
        """What stands on the panel."""
        return "\n".join(rows(self.query_one(RoomMap)))


# ---------------------------------------------------------------- how it looks


# ---------------------------------------------------------------- why it is empty


@pytest.mark.parametrize(
    ("trouble", "more", "words"),
    [
        (Trouble.NO_PUBLISHER, NOBODY, ("nobody publishes this topic", "/odom", "Start chassis")),
        (Trouble.QUIET, {"age_s": None}, ("no message has arrived yet", "/odom", "Its log says")),
        (Trouble.UNKNOWN_TYPE, {"detail": "my/Odom"}, ("is not installed", "/odom: my/Odom")),
        (Trouble.QOS_MISMATCH, {"detail": "best effort"}, ("QoS is incompatible", "best effort")),
    ],
)
async def test_without_odometry_it_says_why_and_what_to_do(
    trouble: Trouble, more: dict[str, Any], words: tuple[str, ...]
) -> None:
    app = Alone()
    async with app.run_test(size=(100, 20)):
        rows = {"/odom": {**more, "trouble": trouble}, "/mock/pose": NOBODY}
        text = app.tell(map_update(rows, odom=(), mock_pose=()))
        assert all(word in text for word in words)


async def test_odometry_that_falls_silent_is_greyed_with_its_age_and_not_taken_for_the_truth() -> (
    None
):
    app = Alone()
    async with app.run_test(size=(100, 20)):
        gone = map_update({"/odom": {**NOBODY, "age_s": 5.3}}, odom=())
        text = app.tell(map_update(), gone)
        assert "no data for 5 s" in text
        assert "path 2." in text
        looks = {
            ink.look for line in app.query_one(RoomMap)._lines for ink in line if ink.text.strip()
        }
        assert looks == {"muted", "alert"}
        assert app.query_one(MapPanel).border_title == "Map"


# ---------------------------------------------------------------- what it shows


async def test_without_odometry_the_truth_of_a_simulated_robot_is_shown_and_named() -> None:
    app = Alone()
    async with app.run_test(size=(100, 20)):
        there = stamped("/mock/pose", Pose(1.0, 1.0))
        text = app.tell(map_update({"/odom": NOBODY}, odom=(), mock_pose=(there,)))
        assert "x 1.00  y 1.00 m" in text
        assert app.query_one(MapPanel).border_title == "Map ← /mock/pose"
        text = app.tell(map_update(odom=(odometry(Pose(0.5, 0.5)),), mock_pose=(there,)))
        assert "x 0.50  y 0.50 m" in text
        assert "true pose, 0.71 m off" in text
        assert "path" not in text
        assert app.query_one(MapPanel).border_title == "Map"


async def test_a_goal_goes_with_its_end_and_with_its_publisher() -> None:
    app = Alone()
    async with app.run_test(size=(100, 20)):
        assert "goal 1." in app.tell(map_update())
        over = stamped("/goal_pose", Pose(), frame="")
        assert "goal" not in app.tell(map_update(goal_pose=(over,)))
        assert "goal" in app.tell(map_update())
        assert "goal" not in app.tell(map_update({"/goal_pose": NOBODY}, goal_pose=()))


async def test_a_sonar_that_falls_silent_is_blind_and_one_that_is_gone_is_not_drawn() -> None:
    app = Alone()
    async with app.run_test(size=(100, 20)):
        assert "● front" in app.tell(map_update())
        silent = {"/sensor/sonar_front": {"trouble": Trouble.QUIET}}
        text = app.tell(map_update(silent, sonar_front=()))
        assert "? front no valid reading" in text
        assert text.count("?") == 2
        assert "front" not in app.tell(map_update({"/sensor/sonar_front": NOBODY}, sonar_front=()))


async def test_a_recording_that_is_turned_back_begins_a_new_path() -> None:
    app = Alone()
    async with app.run_test(size=(100, 20)):
        assert "path 2." in app.tell(map_update())
        assert "path" not in app.tell(map_update(odom=(odometry(Pose(1.0, 0.0), 2.0),)))


async def test_it_is_drawn_anew_only_if_a_cell_looks_different(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    app = Alone()
    async with app.run_test(size=(100, 30)):
        draws: list[int] = []
        real = RoomMap.redraw

        def counted(drawing: RoomMap) -> None:
            draws.append(len(draws))
            real(drawing)

        monkeypatch.setattr(RoomMap, "redraw", counted)
        here = Pose(1.0, 0.2, 0.3)
        there = stamped("/mock/pose", here)
        app.tell(map_update(odom=(odometry(here, 20.0),), mock_pose=(there,)))
        draws.clear()
        for step in range(20):
            near = replace(here, x_m=1.0 + 1e-4 * step)
            trembling = (reading("rear", 1.2 + 0.001 * step),)
            app.tell(
                map_update(
                    odom=(odometry(near, 21.0 + step),),
                    mock_pose=(stamped("/mock/pose", near),),
                    sonar_rear=trembling,
                    map=(),
                )
            )
        assert len(draws) <= 2
        before = app.text
        draws.clear()
        app.tell(map_update(odom=(odometry(Pose(1.2, 0.2, 0.3), 50.0),), map=()))
        assert draws
        assert app.text != before
