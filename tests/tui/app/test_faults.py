"""What fails on the screen is told in its own place, and the rest goes on: the stop above all."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass, replace
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.screen import Screen
from textual.widget import Widget

from graph.observer.requests import Publish
from tests.tui.recorded import RecordedGraph, RecordedOpener, RecordedSession, lesson_samples, lesson_update
from tests.tui.snapshots import LESSON_9, settle
from tests.waiting import until
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.dialogs.safe import Plainly, SafeScreen
from tui.frame.title_bar import TitleBar
from tui.isolation import isolating
from tui.panels.head import HeadView
from tui.panels.panel import Panel
from tui.panels.wheels import WheelsPanel, WheelsView


@dataclass
class Isolated:
    """The app as a person has it: what its widgets raise is told, and it goes on."""

    app: DeckApp
    pilot: Pilot[Any]
    graph: RecordedGraph
    journal: list[tuple[str, str]]

    async def look(self) -> None:
        """Let the graph say something, and have it shown."""
        self.graph.show(lesson_update())
        await self.pilot.pause()

    async def stops(self) -> bool:
        """Whether the space bar still stops the wheels."""
        await self.pilot.press("space")
        await until(lambda: self.graph.asked(Publish), "what is published")
        topic, _type, message = self.graph.asked(Publish)[-1][:3]
        return (topic, message) == ("/emergency_stop", {"data": True})


@asynccontextmanager
async def isolated() -> AsyncIterator[Isolated]:
    graph = RecordedGraph()
    journal: list[tuple[str, str]] = []
    app = DeckApp(RecordedOpener(graph=graph), LESSON_9, journal=lambda *noted: journal.append(noted))
    with isolating():
        async with app.run_test(size=(120, 40)) as pilot:
            await settle(pilot)
            yield Isolated(app, pilot, graph, journal)
            assert app.is_running
            assert not app.crashed


@contextmanager
def broken(thing: type, method: str) -> Iterator[None]:
    def fail(*_: object, **__: object) -> None:
        raise ZeroDivisionError("broken on purpose")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(thing, method, fail)
        yield


def shown(widget: Widget) -> str:
    lines = widget.render_lines(widget.outer_size.region)
    return "\n".join(line.text.rstrip() for line in lines)


FAULT = "has failed (ZeroDivisionError: broken on purpose). Everything else keeps working."


def flat(text: str) -> str:
    """A text as it was before it was wrapped."""
    return " ".join(text.replace("│", " ").split())


async def test_a_panel_that_cannot_show_says_so_until_it_can() -> None:
    async with isolated() as deck:
        wheels = deck.app.screen.query_one(WheelsPanel)
        head = deck.app.screen.query_one(HeadView)
        with broken(WheelsView, "show"):
            await deck.look()
            assert f"Wheels {FAULT}" in flat(shown(wheels))
            assert "45° left" in shown(head)
            assert not wheels.query_one(WheelsView).region
            await deck.look()
        assert [words for words, _trace in deck.journal] == [f"Wheels {FAULT}"]
        assert "broken on purpose" in deck.journal[0][1]
        assert "Traceback" in deck.journal[0][1]
        assert await deck.stops()
        await deck.look()
        assert "has failed" not in shown(wheels)
        assert "29° left" in shown(wheels.query_one(WheelsView))


async def test_what_cannot_be_rendered_leaves_the_others_on_the_screen() -> None:
    async with isolated() as deck:
        widget = deck.app.screen.query_one(TitleBar)
        with broken(TitleBar, "render"):
            widget.refresh()
            await deck.pilot.pause()
            assert "ZeroDivisionError" in shown(widget)
            await deck.look()
            assert "45° left" in shown(deck.app.screen.query_one(HeadView))
            assert await deck.stops()
        widget.refresh()
        await deck.pilot.pause()
        await deck.pilot.pause()
        assert "ZeroDivisionError" not in shown(widget)


async def test_timers_workers_and_callbacks_that_fail_end_nothing() -> None:
    def fail() -> None:
        raise ZeroDivisionError("broken on purpose")

    async def work() -> None:
        fail()

    async with isolated() as deck:
        screen = deck.app.screen
        screen.set_timer(0.001, fail)
        await until(lambda: len(deck.journal) == 1, "the fault in the journal")
        # One that fails at the same place is the same.
        screen.run_worker(work(), exit_on_error=True)
        screen.call_later(fail)
        deck.app.call_later(fail)
        screen.call_after_refresh(fail)
        deck.app.run_worker(work())
        await deck.pilot.pause(0.05)
        assert len(deck.journal) == 1
        assert await deck.stops()


async def test_a_screen_that_cannot_be_laid_out_gives_way_to_one_that_can() -> None:
    async with isolated() as deck:
        with broken(LessonDeck, "arrange"):
            deck.app.screen.refresh(layout=True)
            await until(lambda: isinstance(deck.app.screen, SafeScreen), "the plain screen")
            await until(lambda: any(map(shown, deck.app.screen.query(Plainly))), "its words")
            words = shown(deck.app.screen.query_one(Plainly))
            assert "cannot be drawn" in words
            assert "09-brain" in words
            assert "space" in words
            assert await deck.stops()
            await until(lambda: "EMERGENCY STOP" in shown(deck.app.screen.query_one(Plainly)), "the stop")
        await deck.pilot.press("f2")
        await until(lambda: isinstance(deck.app.screen, LessonDeck), "the deck")
        await until(lambda: deck.app.screen.query(Panel), "its panels")


async def test_when_nothing_can_be_drawn_the_nodes_are_stopped_the_normal_way() -> None:
    session = RecordedSession()
    app = DeckApp(RecordedOpener(session), LESSON_9, journal=lambda *_: None)
    with isolating():
        async with app.run_test(size=(120, 40)) as pilot:
            await settle(pilot)
            with broken(Screen, "arrange"):
                app.screen.refresh(layout=True)
                await until(lambda: app.return_code is not None, "the end of the app")
            assert app.return_code == 1
            assert ("shutdown",) in session.asked
            assert "cannot draw its screen" in app.sessions.parting_words


async def test_a_fault_of_the_emergency_stop_does_not_keep_the_panels_waiting() -> None:
    async with isolated() as deck:
        with broken(type(deck.app.emergency), "see"):
            samples = lesson_samples()
            turned = replace(samples["/head_state"][0], value={"name": ["pan_joint"], "position": [-0.5]})
            deck.graph.show(lesson_update(samples={**samples, "/head_state": (turned,)}))
            await deck.pilot.pause()
            assert "29° right" in shown(deck.app.screen.query_one(HeadView))
        assert "Deck has failed" in deck.journal[0][0]
