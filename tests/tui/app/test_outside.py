"""A node that is started by hand beside the lesson: listed, heard, and nobody's to stop."""

from __future__ import annotations

from typing import Any

import pytest
from textual.pilot import Pilot

from graph.data import GraphUpdate, NodeRow, Sample
from launcher.status import LogLine, Severity
from tests.tui.recorded import NODES, NOW_S, RecordedOpener, lesson_update, sample
from tests.tui.snapshots import opened, settle
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.frame import title
from tui.frame.key_bar import KeyBar
from tui.logs.screen import LogsScreen
from tui.session.outside import Outside

pytestmark = pytest.mark.nightly

OWN = tuple(NodeRow(f"/{name}") for name in NODES)
HELPERS = ("/_deck_observer_7", "/_deck_recorder_7", "/_ros2cli_daemon_42_1", "/a/_hidden")
STARTED_HERE = 7


def graph(*names: str, samples: tuple[Sample, ...] = ()) -> GraphUpdate:
    """The lesson's graph with these nodes beside its own."""
    rows = sorted((*OWN, *map(NodeRow, names)), key=lambda row: row.name)
    return lesson_update(nodes=tuple(rows), samples={"/rosout": samples} if samples else {})


def said(text: str, logger: str = "my_node", at_s: int = 0) -> Sample:
    stamp = {"sec": int(NOW_S) + at_s, "nanosec": 0}
    value = {"stamp": stamp, "level": 30, "name": logger, "msg": text, "line": 1}
    return sample("/rosout", "rcl_interfaces/msg/Log", value)


def rows_of(app: DeckApp) -> list[list[str]]:
    """The table of nodes, those below its last line as well."""
    assert isinstance(app.screen, LessonDeck)
    return [[cell.text for cell in row.cells] for row in app.screen.table._rows]


def offered(app: DeckApp) -> set[str]:
    bar = app.screen.query_one(KeyBar)
    return {key.title for key in bar.keys()}  # noqa: SIM118 - no mapping


async def show(opener: RecordedOpener, pilot: Pilot[Any], update: GraphUpdate) -> None:
    opener.graph.show(update)
    await settle(pilot)


async def test_it_stands_below_decks_own_until_it_leaves_the_graph() -> None:
    opener = RecordedOpener()
    async with opened(opener, size=(80, 24)) as (app, pilot):
        own = rows_of(app)
        await show(opener, pilot, graph("/my_node", "/arm/driver", *HELPERS))
        shown = rows_of(app)
        assert shown[: len(NODES)] == own
        assert [row[:3] for row in shown[len(NODES) :]] == [
            ["arm/driver", "◇ outside", "—"],
            ["my_node", "◇ outside", "—"],
        ]
        assert "● 8/8" in title.states(app)[0]
        await show(opener, pilot, graph())
        assert rows_of(app) == own


async def test_it_cannot_be_started_or_stopped_and_the_keys_say_why() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await show(opener, pilot, graph("/my_node"))
        titles = offered(app)
        assert {"Stop", "Restart"} <= titles
        await pilot.press("end")
        await pilot.pause()
        titles = offered(app)
        assert {"Start", "Stop", "Restart"}.isdisjoint(titles)
        for key in "sxr":
            app.clear_notifications()
            await pilot.press(key)
            await pilot.pause()
            (told,) = (one.message for one in app._notifications)
            assert "my_node was not started by Deck" in told
        assert opener.link.asked == []
        await pilot.press("X")
        await pilot.pause()
        assert opener.link.asked == [("stop",)]


async def test_what_it_says_on_rosout_is_in_the_log_and_decks_own_are_not_doubled() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert "/rosout" not in opener.graph.wanted.followed
        early = said("I am awake")
        await show(opener, pilot, graph("/my_node", "/arm/driver"))
        assert "/rosout" in opener.graph.wanted.followed
        lines = (
            early,
            said("of Deck's own", "sonar_front"),
            said("of a part of it", "sonar_front.serial"),
            said("moved", "arm.driver.motor"),
            said("here before it is seen", "late"),
            # A subscription that is opened anew hears again what publishers keep.
            early,
        )
        await show(opener, pilot, graph("/my_node", "/arm/driver", samples=lines))

        def heard() -> list[tuple[str, str]]:
            every = app.feed.history.all()
            return [(line.node, line.text) for line in every if line.source == "rosout"]

        first = [("my_node", "I am awake"), ("arm/driver", "moved")]
        assert heard() == first
        await show(opener, pilot, graph("/my_node", "/arm/driver", "/late"))
        assert heard() == [*first, ("late", "here before it is seen")]
        await pilot.press("4")
        await settle(pilot)
        assert isinstance(app.screen, LogsScreen)
        assert {"my_node", "arm/driver", "late"} <= app.screen.pane.view.ring.counts.keys()
        await show(opener, pilot, graph())
        assert "/rosout" not in opener.graph.wanted.followed


def outside(*rows: NodeRow) -> tuple[str, ...]:
    """Who is outside beside the nodes of lesson 9."""
    found = Outside()
    found.see(lesson_update(nodes=rows), NODES, "run")
    return found.now


def test_a_process_that_deck_has_started_is_its_own_under_any_name(monkeypatch: pytest.MonkeyPatch) -> None:
    marks = {STARTED_HERE: {"DECK_RUN_ID": "run"}, 8: {}, 9: {"DECK_RUN_ID": "another"}}
    monkeypatch.setattr("launcher.processes.table.process_numbers", lambda: [*marks, 65536 + 8])
    monkeypatch.setattr("launcher.processes.table.read_marks", marks.get)
    # `exec: [rviz2]` under the key `viewer`.
    assert outside(NodeRow("/rviz", processes=(STARTED_HERE,))) == ()
    # A second one of the name of a node of Deck's.
    assert outside(NodeRow("/camera", processes=(STARTED_HERE,))) == ()
    assert outside(NodeRow("/camera", processes=(STARTED_HERE, 8))) == ("/camera",)
    assert outside(NodeRow("/camera", processes=(9,))) == ("/camera",)
    # One that has crashed stays in the tables for a while; one may be on another machine.
    assert outside(NodeRow("/camera", processes=(10,))) == ()
    assert outside(NodeRow("/far", processes=(10,))) == ("far",)
    # The name of a node may be known a little before its process.
    assert outside(NodeRow("/camera", processes=(STARTED_HERE,)), NodeRow("/new")) == ()


def test_of_two_by_one_name_it_is_told_by_what_decks_own_has_not_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("launcher.processes.table.process_numbers", lambda: [8])
    monkeypatch.setattr("launcher.processes.table.read_marks", lambda _pid: {})
    here = Outside()
    here.see(lesson_update(nodes=(NodeRow("/camera", processes=(8,)),)), NODES, "run")
    monkeypatch.setattr("tui.clock.now", lambda: NOW_S)
    both = (said("Deck's", "camera", at_s=2), said("another's", "camera", at_s=3))
    assert here.lines(both, NODES) == (), "the output of Deck's may still come"
    here.note([LogLine("camera", 1, NOW_S // 1 + 2, Severity.INFO, "Deck's", logger="camera")])
    monkeypatch.setattr("tui.clock.now", lambda: NOW_S + 2)
    (line,) = here.lines((), NODES)
    assert (line.node, line.text) == ("/camera", "another's")
