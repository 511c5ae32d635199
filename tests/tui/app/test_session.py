"""The app and its session: opened, fed, closed, left; nothing lost and nothing left behind."""

from __future__ import annotations

import asyncio
import gc
import threading
from collections import Counter
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from textual.css.styles import RenderStyles, StylesBase
from textual.dom import DOMNode
from textual.message import Message
from textual.pilot import Pilot
from textual.signal import Signal
from textual.strip import Strip
from textual.timer import Timer

from graph.data import GraphUpdate, Sample
from graph.observer.requests import Publish, StopCommanding
from graph.observer.updates import KEPT_BYTES, KEPT_SAMPLES
from launcher.client import client
from launcher.errors import ProfileError, ProfileProblem, SessionError
from launcher.events import ClosedEvent, StraysEvent
from launcher.status import NodeState, Stray, Who
from tests.dying_supervisor import DyingSupervisor
from tests.tui.recorded import LINES, NOW_S, SESSION, RecordedOpener, RecordedSession, lesson_update
from tests.tui.snapshots import LESSON_9, opened, settle
from tests.waiting import until
from text.sentences import say
from tui.app import DeckApp
from tui.clock import time_of_day
from tui.deck.actions import start_all, write_command
from tui.deck.nodes_table import NodesTable
from tui.deck.screen import LessonDeck
from tui.frame import title
from tui.frame.title_bar import TitleBar
from tui.lifecycle.dialogs import EndSessionScreen, StoppingScreen, StraysScreen
from tui.logs.screen import LogsScreen
from tui.panels.head import HeadView
from tui.panels.wheels import WheelsView
from tui.picker.screen import PickerScreen
from tui.session.past import GraphInbox
from tui.session.ports import SessionLink
from tui.session.requests import OpenRequest
from tui.topics.screen import TopicsScreen

ATTACHED = replace(SESSION, foreground=False, started_by=Who(4000, "ann", "pts/2", "10.0.0.7"))
STRAY = Stray(4711, NOW_S - 600, "camera", "python -m nodes.mock_camera", "20251231-1")


async def test_screens_are_switched_by_digits_and_function_keys() -> None:
    async with opened() as (app, pilot):
        for key, screen in (("2", TopicsScreen), ("f5", LogsScreen), ("f3", TopicsScreen)):
            await pilot.press(key)
            await pilot.pause()
            assert isinstance(app.screen, screen)


async def test_leaving_stops_the_nodes_that_this_screen_has_started() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("q")
        await pilot.pause()
        assert opener.link.asked == [("shutdown",), ("aclose",)]
        assert opener.graph.stopped
        assert app.return_code == 0


async def test_leaving_an_attached_session_leaves_it_running_and_names_what_ends_it() -> None:
    opener = RecordedOpener(RecordedSession(ATTACHED))
    async with opened(opener) as (app, pilot):
        await pilot.press("q")
        await pilot.pause()
        assert opener.link.asked == [("aclose",)]
        assert app.sessions.parting_words == ("left running: 09-brain in domain 42; `deck down 09-brain` ends it")
        assert app.return_code == 0


async def test_what_another_screen_has_started_is_ended_only_if_asked_and_says_whose() -> None:
    opener = RecordedOpener(RecordedSession(replace(ATTACHED, foreground=True)))
    opener.link.own = False
    async with opened(opener) as (app, pilot):
        await pilot.press("shift+f8")
        await settle(pilot)
        assert isinstance(app.screen, EndSessionScreen)
        assert "ann on pts/2 from 10.0.0.7 (pid 4000)" in str(app.screen.words())
        await pilot.press("escape")
        await settle(pilot)
        assert opener.link.asked == []
        await pilot.press("shift+f8")
        await settle(pilot)
        await pilot.press("enter")
        await settle(pilot)
        assert opener.link.asked == [("shutdown",), ("aclose",)]
        assert isinstance(app.screen, PickerScreen)


async def test_while_nodes_are_stopping_it_says_which_and_q_again_does_not_wait() -> None:
    opener = RecordedOpener()
    opener.link.hold_shutdown = True
    async with opened(opener) as (app, pilot):
        await pilot.press("q")
        await pilot.pause()
        assert isinstance(app.screen, StoppingScreen)
        assert "safety_stop" in str(app.screen.words())
        await pilot.press("q")
        await pilot.pause()
        assert ("shutdown", "now") in opener.link.asked


async def test_closing_a_session_goes_back_to_the_lessons_and_another_can_be_opened() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("4", "f8")
        await settle(pilot)
        assert isinstance(app.screen, PickerScreen)
        assert opener.link.asked == [("shutdown",), ("aclose",)]
        opener.link = RecordedSession()
        await pilot.press("enter")
        await settle(pilot)
        assert app.feed.session is SESSION
        assert [one.text for one in app.feed.history.all()] == [one.text for one in LINES]


async def test_a_session_that_ends_says_why_and_its_log_can_still_be_read() -> None:
    opener, may_leave = RecordedOpener(), threading.Event()
    leave = opener.graph.stop
    opener.graph.stop = lambda: leave() if may_leave.wait(60) else None  # type: ignore[method-assign]
    async with opened(opener) as (app, pilot):
        opener.link.say(ClosedEvent(say("the supervisor is gone")))
        await settle(pilot)
        assert title.states(app)[0] == "the supervisor is gone"
        # Leaving the graph may take a while, or fail; until then, nothing is to drive.
        assert opener.graph.asked(StopCommanding)
        assert not opener.graph.stopped
        may_leave.set()
        await pilot.press("4")
        await pilot.pause()
        assert isinstance(app.screen, LogsScreen)
        assert app.screen.pane.view.ring.entries
        await pilot.press("f8")
        await settle(pilot)
        assert isinstance(app.screen, PickerScreen)
    await until(lambda: opener.graph.stopped, "the graph left")


@pytest.mark.parametrize("dies_on", ["attend", "history"])
async def test_a_supervisor_that_dies_while_its_session_opens_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, dies_on: str | None
) -> None:
    """At each moment at which the screen waits for it."""
    monkeypatch.setattr(client, "find_running", lambda _name: SimpleNamespace(folder=tmp_path))
    supervisor = DyingSupervisor(tmp_path, dies_on=dies_on)
    await supervisor.serve()

    class Opener(RecordedOpener):
        async def open(self, order: OpenRequest) -> SessionLink:
            self.orders.append(order)
            return await client.attach()

    app = DeckApp(Opener(), LESSON_9, "deck")
    async with app.run_test(size=(120, 40)) as pilot:
        await until(lambda: app.feed.ended, "the end of the session")
        await pilot.pause()
        assert title.states(app)[0] == "the supervisor is gone"
        assert [note.message for note in app._notifications] == ["the supervisor is gone"]
        await pilot.press("q")
        await until(lambda: app._exit, "the end of the screen")
    assert app.return_code == 0
    supervisor.stop()


async def test_a_session_that_ends_leaves_no_node_ready_and_no_panel_that_seems_alive() -> None:
    opener = RecordedOpener()
    async with opened(opener, size=(200, 60)) as (app, pilot):
        opener.graph.show(lesson_update())
        opener.link.set_state("camera", NodeState.FAILED, signal="SIGSEGV", pid=None)
        await settle(pilot)
        drawings = list(app.screen.query(WheelsView)) + list(app.screen.query(HeadView))
        assert [drawing.stale for drawing in drawings] == [False, False]
        opener.link.say(ClosedEvent(say("the supervisor is gone")))
        await settle(pilot)
        table = app.screen.query_one(NodesTable)
        rows = [table.render_line(y).text for y in range(1, 9)]
        well = ["camera" not in row for row in rows]
        assert ["○ exited" in row and "the supervisor is gone" in row for row in rows] == well
        assert "ended by SIGSEGV" in rows[1]
        assert [drawing.stale_words for drawing in drawings] == ["nobody publishes this topic"] * 2
        assert isinstance(app.screen, LessonDeck)
        assert not start_all.possible(app.screen)
        assert not write_command.possible(app.screen)


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (ProfileError([ProfileProblem("a.yaml", 3, 5, "nodes", say("unknown key"))]), 2),
        (SessionError(say("the supervisor does not answer")), 1),
    ],
)
async def test_what_was_named_and_cannot_be_opened_ends_the_program_with_words(error: Exception, code: int) -> None:
    app = DeckApp(RecordedOpener(refusal=error), LESSON_9)
    async with app.run_test() as pilot:
        await settle(pilot)
    assert app.return_code == code
    assert app.sessions.parting_words == str(error)


async def test_what_an_earlier_run_left_behind_is_offered_for_stopping() -> None:
    opener = RecordedOpener()
    opener.link.say(StraysEvent((STRAY,)))
    async with opened(opener) as (app, pilot):
        await pilot.pause()
        assert isinstance(app.screen, StraysScreen)
        assert "4711" in str(app.screen.words())
        await pilot.press("enter")
        await pilot.pause()
        assert opener.link.asked == [("stop_strays", "camera")]


@pytest.mark.parametrize(("size", "kept"), [(8, KEPT_SAMPLES), (5_000_000, KEPT_BYTES // 5_000_000)])
def test_many_and_large_messages_do_not_pile_up(size: int, kept: int) -> None:
    inbox = GraphInbox(lambda: None)
    for at_s in range(2 * KEPT_SAMPLES):
        said = Sample("/cloud", "a/msg/B", float(at_s), 0.0, size, {})
        inbox.put(GraphUpdate(float(at_s), samples={"/cloud": (said,)}))
    update = inbox.take()
    assert update is not None
    waiting = update.samples["/cloud"]
    assert 1 < len(waiting) <= kept
    assert waiting[-1].received_s == 2.0 * KEPT_SAMPLES - 1


SINCE_S = 1_700_000_000.0


async def test_the_title_says_since_when_what_is_shown_is_old() -> None:
    opener, update = RecordedOpener(), lesson_update()
    async with opened(opener, size=(200, 40)) as (app, pilot):
        bar = app.screen.query_one(TitleBar)

        async def shown(since_s: float | None) -> str:
            opener.graph.show(replace(update, old_since_s=since_s))
            await settle(pilot)
            return bar.text

        assert "No word" not in await shown(None)
        assert f"No word of the ROS graph since {time_of_day(SINCE_S)}" in await shown(SINCE_S)
        await pilot.resize_terminal(120, 24)
        await settle(pilot)
        assert f"No word of the ROS graph since {time_of_day(SINCE_S)}" in bar.text
        await pilot.press("space")
        await settle(pilot)
        assert opener.graph.asked(Publish)[-1][2] == {"data": True}


TABS = ("f2", "f3", "f4", "f5", "L", "5", "6", "7", "8", "9")
KINDS = (DOMNode, Timer, asyncio.Task, StylesBase, RenderStyles, Message, Signal, Strip)


@pytest.mark.nightly
@pytest.mark.timeout(300)
async def test_changing_tabs_leaves_nothing_behind() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (_app, pilot):
        await change_tabs(pilot, opener, rounds=2)
        before = living()
        await change_tabs(pilot, opener, rounds=2)
        assert living() - before == Counter()


async def change_tabs(pilot: Pilot[Any], opener: RecordedOpener, rounds: int) -> None:
    """Show each screen in turn, each with new data, and end at the first."""
    update = opener.graph.update
    assert update is not None
    for _round in range(rounds):
        for tab in (*TABS, TABS[0]):
            await pilot.press(tab)
            opener.graph.show(update)
            await pilot.pause()


def living() -> Counter[str]:
    """Count what is reachable, by its kind; of the same screen it is always as much."""
    gc.collect()
    kinds = [kind for each in gc.get_objects() for kind in KINDS if isinstance(each, kind)]
    return Counter(kind.__name__ for kind in kinds)
