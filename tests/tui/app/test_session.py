"""The app and its session: opened, fed, closed, left; nothing lost and nothing left behind."""

from __future__ import annotations

import gc
import threading
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any
from weakref import ref

import pytest
from textual.widget import Widget

from launcher.client import client
from launcher.errors import ProfileError, ProfileProblem, SessionError
from launcher.events import ClosedEvent, StraysEvent
from launcher.status import NodeState, Stray, Who
from tests.dying_supervisor import DyingSupervisor
from tests.tui.app_runs import LESSON_9, opened
from tests.tui.recorded import (
    LINES,
    NOW_S,
    SESSION,
    RecordedGraph,
    RecordedOpener,
    RecordedSession,
    lesson_update,
    line,
)
from tests.tui.snapshots import settle
from tests.waiting import until
from text.sentences import say
from tui.app import DeckApp
from tui.deck.actions import StartAll, WriteCommand
from tui.deck.nodes_table import NodesTable
from tui.deck.screen import LessonDeck
from tui.frame import title
from tui.frame.key_bar import KeyBar
from tui.lifecycle.end_session import EndSessionScreen
from tui.lifecycle.stopping import StoppingScreen
from tui.lifecycle.strays import StraysScreen
from tui.logs.screen import LogsScreen
from tui.panels.head.widget import HeadView
from tui.panels.wheels.widget import WheelsView
from tui.picker.screen import PickerScreen
from tui.session.history import LogHistory
from tui.session.ports import SessionLink
from tui.session.requests import OpenRequest
from tui.topics.screen import TopicsScreen

if TYPE_CHECKING:
    from textual.pilot import Pilot


class AppEnvironment:
    """Notes what it is to remember."""

    terminal_fd = 1

    def __init__(self) -> None:
        self.kept: dict[str, str] = {}

    def arrive(self, app: DeckApp) -> None:
        del app

    def desert(self) -> None:
        """Its terminal stays."""

    def remember(self, **values: str) -> None:
        self.kept.update(values)


ATTACHED = replace(SESSION, foreground=False, started_by=Who(4000, "ann", "pts/2", "10.0.0.7"))
ATTACH = OpenRequest(attach="09-brain")
STRAY = Stray(4711, NOW_S - 600, "camera", "python -m nodes.mock_camera", "20251231-1")


async def tour(pilot: Pilot[Any]) -> list[ref[Widget]]:
    """Look at every screen of the session; return all that they are made of."""
    seen = []
    for key in ("f3", "f4", "f5", "5", "6", "7", "f2"):
        await pilot.press(key)
        await settle(pilot)
        screen = pilot.app.screen
        seen += [ref(widget) for widget in (screen, *screen.walk_children(Widget))]
    return seen


async def close(app: DeckApp, pilot: Pilot[Any]) -> None:
    app.sessions.close()
    await app.workers.wait_for_complete([w for w in app.workers if w.group == "leaving"])
    await settle(pilot)
    assert isinstance(app.screen, PickerScreen)
    gc.collect()


async def test_the_screens_of_a_session_that_is_closed_are_not_kept_in_memory() -> None:
    async with opened() as (app, pilot):
        seen = await tour(pilot)
        await close(app, pilot)
        assert [repr(widget()) for widget in seen if widget() is not None] == []


async def test_one_that_is_opened_while_another_is_closed_waits_for_that() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        app.sessions.close()
        app.sessions.open(app.sessions.request)
        await app.workers.wait_for_complete([w for w in app.workers if w.group == "leaving"])
        await settle(pilot)
        assert isinstance(app.screen, LessonDeck)
        assert opener.link.asked == [("shutdown",), ("aclose",)]
        assert app.feed.session is SESSION


@pytest.mark.parametrize(("order", "lesson"), [(LESSON_9, "09-brain"), (ATTACH, None)])
async def test_the_lesson_that_was_started_is_remembered_one_attached_to_is_not(
    order: OpenRequest, lesson: str | None
) -> None:
    around = AppEnvironment()
    app = DeckApp(RecordedOpener(), order, "deck", environment=around)
    async with app.run_test() as pilot:
        await settle(pilot)
        assert app.feed.session is SESSION
        assert around.kept.get("lesson") == lesson


def test_the_history_of_the_log_is_bounded_in_lines_and_in_characters() -> None:
    history = LogHistory(lines=10, characters=100)
    history.add(line("camera", n, "x") for n in range(50))
    assert [one.seq for one in history.all()] == list(range(40, 50))
    history.add([line("camera", 51, "y" * 95)])
    assert sum(len(one.text) for one in history.all()) <= 100


@pytest.mark.parametrize(
    ("keys", "screen"), [("2", TopicsScreen), ("f3", TopicsScreen), ("f5", LogsScreen)]
)
async def test_screens_are_switched_by_digits_and_function_keys(keys: str, screen: type) -> None:
    async with opened() as (app, pilot):
        await pilot.press(keys)
        await pilot.pause()
        assert isinstance(app.screen, screen)


async def test_screens_are_switched_by_a_click_on_the_title() -> None:
    async with opened() as (app, pilot):
        at = str(app.screen.query_one("TitleBar").render()).index("4 Logs")
        await pilot.click("TitleBar", offset=(at + 1, 0))
        await pilot.pause()
        assert isinstance(app.screen, LogsScreen)


async def test_leaving_stops_the_nodes_that_this_screen_has_started() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("q")
        await pilot.pause()
        assert opener.link.asked == [("shutdown",), ("aclose",)]
        assert opener.graph.stopped
        assert app.return_code == 0


async def test_leaving_an_attached_session_leaves_it_running() -> None:
    opener = RecordedOpener(RecordedSession(ATTACHED))
    async with opened(opener) as (_app, pilot):
        await pilot.press("ctrl+q")
        await pilot.pause()
        assert opener.link.asked == [("aclose",)]


def footer(app: DeckApp) -> str:
    """Return the keys that are shown."""
    return str(app.screen.query_one(KeyBar).render())


def of_another_screen() -> RecordedOpener:
    """A session that a screen elsewhere has started in its own foreground."""
    opener = RecordedOpener(RecordedSession(replace(ATTACHED, foreground=True)))
    opener.link.own = False
    return opener


async def test_leaving_does_not_end_what_another_screen_has_started() -> None:
    opener = of_another_screen()
    async with opened(opener) as (app, pilot):
        assert "q Detach" in footer(app)
        await pilot.press("q", "q")
        await pilot.pause()
        assert opener.link.asked == [("aclose",)]
        assert app.sessions.parting_words.startswith("left as it is: 09-brain in domain 42")


async def test_what_is_left_running_is_named_with_what_ends_it() -> None:
    opener = RecordedOpener(RecordedSession(ATTACHED))
    async with opened(opener) as (app, pilot):
        await pilot.press("q")
        await pilot.pause()
        assert app.sessions.parting_words == (
            "left running: 09-brain in domain 42; `deck down 09-brain` ends it"
        )
        assert app.return_code == 0


async def test_what_another_screen_has_started_is_ended_only_if_asked_and_says_whose() -> None:
    opener = of_another_screen()
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


async def test_a_session_that_is_ended_elsewhere_says_who_did() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.link.say(ClosedEvent(say("ended from elsewhere: {who}", who="bob on pts/3 (pid 7)")))
        await pilot.pause()
        await pilot.pause()
        messages = [note.message for note in app._notifications]
        assert messages == ["ended from elsewhere: bob on pts/3 (pid 7)"]


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
        await pilot.pause()
        await pilot.pause()
        assert title.states(app)[0] == "the supervisor is gone"
        # Leaving the graph may take a while, or fail; until then, nothing is to drive.
        assert opener.graph.commands_nothing
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


@pytest.mark.parametrize("dies_on", [None, "attend", "history"])
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
        assert not StartAll.possible(app.screen)
        assert not WriteCommand.possible(app.screen)
        await pilot.press("f9", "f9")
        await settle(pilot)
        assert [table.render_line(y).text for y in range(1, 9)] == rows


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (ProfileError([ProfileProblem("a.yaml", 3, 5, "nodes", say("unknown key"))]), 2),
        (SessionError(say("the supervisor does not answer")), 1),
    ],
)
async def test_what_was_named_and_cannot_be_opened_ends_the_program_with_words(
    error: Exception, code: int
) -> None:
    app = DeckApp(RecordedOpener(refusal=error), LESSON_9)
    async with app.run_test() as pilot:
        await pilot.pause()
        await pilot.pause()
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


async def test_a_graph_that_cannot_be_observed_says_so_and_the_rest_works() -> None:
    opener = RecordedOpener(
        graph=RecordedGraph(lesson_update(error="ROS cannot be used: no rclpy"))
    )
    async with opened(opener) as (app, pilot):
        await pilot.pause()
        assert any("no rclpy" in note.message for note in app._notifications)
        await pilot.press("x")
        await pilot.pause()
        assert opener.link.asked == [("stop", "sonar_front")]
