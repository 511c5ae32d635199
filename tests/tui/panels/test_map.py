"""The map on the screen: what it shows of a robot on its way, and why it shows nothing."""

from __future__ import annotations

from typing import Any

import pytest

from graph.data import GraphUpdate, Trouble
from robot.motion.odometry import Pose
from tests.tui.panel_stage import Bare, rows
from tests.tui.recorded_map import NOBODY, map_update, odometry, stamped
from tests.waiting import until
from tui.panels.map import MapPanel, RoomMap
from tui.terminal.pixels import PICTURE, Graphics, Pixels


class Alone(Bare):
    """The panel, and nothing else."""

    def __init__(self) -> None:
        super().__init__(MapPanel())

    def tell(self, *updates: GraphUpdate) -> str:
        """Show updates; return what stands on the panel then."""
        for update in updates:
            self.query_one(MapPanel).show(update)
        return self.text

    @property
    def text(self) -> str:
        return "\n".join(rows(self.query_one(RoomMap)))


@pytest.mark.parametrize(
    ("trouble", "more", "words"),
    [
        (Trouble.NO_PUBLISHER, NOBODY, ("nobody publishes this topic", "/odom", "Start chassis")),
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


async def test_odometry_that_falls_silent_is_greyed_with_its_age_and_not_taken_for_the_truth() -> None:
    app = Alone()
    async with app.run_test(size=(100, 20)):
        gone = map_update({"/odom": {**NOBODY, "age_s": 5.3}}, odom=())
        text = app.tell(map_update(), gone)
        assert "no data for 5 s" in text
        assert "path 2." in text
        looks = {ink.look for line in app.query_one(RoomMap)._lines for ink in line if ink.text.strip()}
        assert looks == {"muted", "alert"}
        assert app.query_one(MapPanel).border_title == "Map"


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


async def test_a_sonar_that_falls_silent_is_blind_and_one_that_is_gone_is_not_drawn() -> None:
    app = Alone()
    async with app.run_test(size=(100, 20)):
        assert "● front" in app.tell(map_update())
        silent = {"/sensor/sonar_front": {"trouble": Trouble.QUIET}}
        text = app.tell(map_update(silent, sonar_front=()))
        assert "? front no valid reading" in text
        assert text.count("?") == 2
        assert "front" not in app.tell(map_update({"/sensor/sonar_front": NOBODY}, sonar_front=()))


async def test_where_the_terminal_has_pixels_the_floor_is_a_picture_of_its_cells() -> None:
    app = Alone()
    app.pixels = Pixels(graphics=Graphics("sixel", (10, 20)))
    async with app.run_test(size=(100, 20)):
        assert "⠒" in app.tell(map_update())
        await until(lambda: PICTURE.search(app.text), "a picture in place of dots")
        assert "path 2." in app.text
        picture = app.pixels.pictures[PICTURE.findall(app.text)[0][0]]
        assert sum(map(len, PICTURE.findall(app.text))) == picture.halves.shape[1] * len(picture.halves) // 2
