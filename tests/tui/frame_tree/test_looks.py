"""How the Frames screen looks, at three sizes and in both languages."""

from __future__ import annotations

from typing import Any

from textual.pilot import Pilot

from tests.tui.recorded import RecordedGraph, RecordedOpener, RecordedSession
from tests.tui.recorded_frames import FOREIGN, TROUBLES, frames_update, topics, with_frames
from tests.tui.snapshots import Look, SnapCompare, both_languages, every_look, one_look, settle


@every_look
def test_a_robot_in_order(look: Look, snap_compare: SnapCompare) -> None:
    """The tree with rates and publishers, the camera relative to odom, nothing wrong."""

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        await pilot.press("down", "down")
        await pilot.pause()

    app = look.app("frames", with_frames())
    assert snap_compare(app, terminal_size=look.size, run_before=before)


@both_languages
def test_everything_wrong(look: Look, dump_compare: SnapCompare) -> None:
    """Each frame that something is wrong with has a mark; what and what to do stands beside."""
    app = look.app("frames", with_frames(TROUBLES, (*topics("camera_lnk"), FOREIGN)))
    assert dump_compare(app, terminal_size=look.size, run_before=look.settle)


@one_look
def test_relative_to_another_frame(look: Look, dump_compare: SnapCompare) -> None:
    """The marked frame has a ring; the sonar is given in the camera, as degrees and metres."""

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        await pilot.press("down", "down", "enter", "down", "down", "down", "down")
        await pilot.pause()

    app = look.app("frames", with_frames())
    assert dump_compare(app, terminal_size=look.size, run_before=before)


@one_look
def test_no_frames(look: Look, dump_compare: SnapCompare) -> None:
    """What is missing, and what to do."""
    empty = RecordedOpener(RecordedSession(lines=()), RecordedGraph(frames_update((), ())))
    app = look.app("frames", empty)
    assert dump_compare(app, terminal_size=look.size, run_before=look.settle)
