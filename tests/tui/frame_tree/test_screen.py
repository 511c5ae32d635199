"""What the Frames screen does: it relates frames, copies, and goes to findings."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from dataclasses import replace

from textual.widgets import Static

from graph.data import FrameRow, TopicRow, Trouble
from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_frames import ROBOT, TROUBLES, frame, frames_update, topics, with_frames
from tests.tui.screen_stage import ScreenStage, on_stage
from tui.frame_tree.screen import FramesScreen


class FramesStage(ScreenStage[FramesScreen]):
    """The screen with its recorded frames."""

    name, kind = "frames", FramesScreen

    async def hear(self, *frames: FrameRow, rows: tuple[TopicRow, ...] = topics()) -> None:
        await self.show(frames_update(frames, rows))

    def tree(self) -> list[str]:
        """The rows, each without the blanks between its cells."""
        table = self.screen.table
        rows = (table.render_line(y).text for y in range(1, table.size.height))
        return [" ".join(row.split()) for row in rows if row.strip()]

    def row(self, name: str) -> str:
        return next(row for row in self.tree() if f" {name} " in f" {row} ")

    def text(self, where: str) -> str:
        return " ".join(str(self.screen.query_one(where, Static).render()).split())

    @property
    def pair(self) -> str:
        return self.text("#frames-pair")

    @property
    def findings(self) -> str:
        return self.text("#frames-findings > Static")


def stage(of: RecordedOpener | None = None) -> AbstractAsyncContextManager[FramesStage]:
    return on_stage(FramesStage, of or with_frames())


async def test_a_frame_is_given_in_its_root_and_stays_up_to_date() -> None:
    async with stage() as at:
        await at.press("down", "down")
        # 0.15 m ahead of a robot at (2, 1) that looks to the left.
        assert at.pair.startswith("camera_link in odom x, y, z, m: 2.000 1.150 0.250")
        assert "roll, pitch, yaw, °: 0.0 0.0 90.0" in at.pair
        assert at.pair.endswith("published by /robot_state_publisher")
        await at.hear(frame("odom", "base_link", (5.0, 0.0, 0.0)), *ROBOT[1:])
        assert "5.150 0.000 0.250" in at.pair


async def test_enter_marks_what_the_others_are_given_in_and_takes_it_back() -> None:
    async with stage() as at:
        await at.press("down", "down", "enter")
        assert "◎" in at.row("camera_link")
        await at.press("down", "down", "down", "down")
        assert at.pair.startswith("sonar_front in camera_link x, y, z, m: 0.050 0.000 -0.150")
        await at.press("alt+x")
        assert at.pair.startswith("camera_link in sonar_front x, y, z, m: -0.050 0.000 0.150")
        await at.press("alt+x", "up", "up", "up", "up", "enter", "down")
        assert "head_pan in odom" in at.pair
        assert not any("◎" in row for row in at.tree())


async def test_the_transform_is_copied_with_what_publishes_it() -> None:
    async with stage() as at:
        await at.press("down", "down", "y")
        lines = at.app.clipboard.splitlines()
        assert lines[0] == "camera_link in odom"
        assert lines[1] == "translation x, y, z [m]: 2.000  1.150  0.250"
        assert lines[2] == "rotation x, y, z, w: 0.0000  0.0000  0.7071  0.7071"
        assert lines[3] == "roll, pitch, yaw [deg]: 0.0  0.0  90.0"
        assert lines[4].startswith("ros2 run tf2_ros static_transform_publisher --x 2 --y 1.15 ")
        assert lines[4].endswith("--frame-id odom --child-frame-id camera_link")
        await at.press("Y")
        assert at.app.clipboard == "ros2 run tf2_ros tf2_echo odom camera_link"


async def test_what_is_silent_is_said_to_be_so_and_recovers() -> None:
    async with stage() as at:
        await at.hear(replace(ROBOT[0], age_s=6.0), *ROBOT[1:])
        assert at.row("base_link").split()[-5:] == ["✗", "stale", "6", "s", "chassis"]
        assert "✗ base_link: silent for 6 s" in at.findings
        await at.hear(*ROBOT)
        assert "50 Hz < 1 s chassis" in at.row("base_link")
        assert at.findings == "✓ nothing is wrong with the frames"


async def test_n_goes_from_one_finding_to_the_next_and_shows_its_words_first() -> None:
    async with stage(with_frames(TROUBLES)) as at:
        seen = []
        for _press in range(6):
            await at.press("n")
            seen.append(at.screen.chosen)
        assert seen[:4] == ["base_link", "head_pan", "head_tilt", "sonar_front"]
        await at.press("N", "N")
        assert at.screen.chosen == "sonar_front"
        assert "findings ✗ sonar_front: /robot_state_publisher, which published it" in at.findings


async def test_without_frames_it_says_what_is_missing() -> None:
    silent = (replace(topics()[1], trouble=Trouble.QUIET, publishers=1),)
    said = "/tf: no message has arrived yet, though there is a publisher"
    async with stage(RecordedOpener(graph=RecordedGraph(frames_update((), silent)))) as at:
        assert at.text("#frames-empty").startswith(said)
        await at.press("y", "enter", "alt+x", "n", "Y")
        await at.hear(*ROBOT)
        assert at.row("base_link")
