"""Driving by keys: who is driven, that it ends with the keys, and what is said meanwhile."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import Any, cast

import pytest
from textual import events
from textual.pilot import Pilot

from graph.data import GraphUpdate
from graph.observer.requests import (
    Hold,
    LetGo,
    PrepareHold,
    PreparePublisher,
    Publish,
    StartPublishing,
    StopCommanding,
)
from launcher.events import ClosedEvent
from robot.topics import DRIVE, DRIVE_TELEOP
from safety.gate_report import gate_in
from safety.topics import SAFETY_STATE
from tests.tui.recorded import (
    NOW_S,
    TOPICS,
    RecordedGraph,
    RecordedOpener,
    lesson_samples,
    lesson_update,
    sample,
    topic,
)
from tests.tui.recorded_emergency import GATE, obeyed, word
from tests.tui.snapshots import opened
from tests.waiting import until
from tui import clock
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.emergency.gate import gate_words
from tui.teleop.actions import Move
from tui.teleop.keys import DRIVE_TYPE, FIRST_HOLD_S
from tui.teleop.widget import TeleopPanel
from tui.terminal.stall_detector import DRAIN_S

STARTED_S = 1.0
"""Long before any key is pressed: a key that is stamped later counts as pressed now."""
SAFETY_TYPE = "diagnostic_msgs/msg/DiagnosticArray"
GATED = (*TOPICS, topic(DRIVE_TELEOP, DRIVE_TYPE, None, publishers=0))


@pytest.fixture(autouse=True)
def _hand_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "steady", lambda: STARTED_S)


def safety(verdict: str = "free", **values: str) -> Any:
    told = {"verdict": verdict, "front": "free", "front_m": "1.840", **values}
    pairs = [{"key": key, "value": value} for key, value in told.items()]
    status = {"level": b"\x00", "name": "safety_stop", "message": "in its words", "values": pairs}
    return sample(SAFETY_STATE, SAFETY_TYPE, {"status": [status]})


def drive(speed: float, steering: float) -> Any:
    value = {"drive": {"speed": speed, "steering_angle": steering}}
    return sample("/drive_safe", DRIVE_TYPE, value)


def gated(said: Any = None, **more: Any) -> GraphUpdate:
    """Lesson 9 with a gate that listens to the keys."""
    samples = lesson_samples()
    samples["/drive_safe"] = (drive(0.08, 0.3),)
    samples[SAFETY_STATE] = (said or safety(),)
    return lesson_update(topics=GATED, samples=samples, **more)


def opener_of(update: GraphUpdate) -> RecordedOpener:
    return RecordedOpener(graph=RecordedGraph(update))


@asynccontextmanager
async def driving(
    opener: RecordedOpener, size: tuple[int, int] = (80, 24)
) -> AsyncIterator[tuple[DeckApp, Pilot[Any], TeleopPanel]]:
    async with opened(opener, size=size) as (app, pilot):
        await pilot.press("t")
        await pilot.pause()
        yield app, pilot, app.screen.query_one(TeleopPanel)


def held(opener: RecordedOpener) -> list[tuple[str, float, float]]:
    """(topic, m/s, rad) of what has been held so far."""
    drives: list[tuple[str, Any]] = [(each[0], each[2].value["drive"]) for each in opener.graph.asked(Hold)]
    return [(name, drive["speed"], drive["steering_angle"]) for name, drive in drives]


def text_of(panel: TeleopPanel) -> str:
    return "\n".join(panel.render_line(y).text for y in range(panel.size.height))


async def test_opening_it_makes_a_publisher_and_publishes_nothing() -> None:
    opener = opener_of(gated())
    async with opened(opener) as (_app, pilot):
        assert [each[0] for each in opener.graph.asked(PreparePublisher)] == ["/emergency_stop"]
        await pilot.press("t")
        await pilot.pause()
        assert opener.graph.asked(PrepareHold) == [(DRIVE_TELEOP, DRIVE_TYPE)]
        assert not opener.graph.asked(Hold)
        assert not opener.graph.asked(Publish)
        assert not opener.graph.asked(StartPublishing)


async def test_each_key_holds_a_command_for_a_while_within_limits_that_keys_change() -> None:
    keys = {
        (0.2, 0.0): ("up", "w", "ц", "W"),
        (-0.2, 0.0): ("down", "s", "ы"),
        (0.0, 0.3): ("left", "a", "ф"),
        (0.0, -0.3): ("right", "d", "в", "В"),
    }
    opener = opener_of(gated())
    async with driving(opener) as (app, pilot, panel):
        for asked, names in keys.items():
            for name in names:
                panel.release()
                await pilot.press(name)
                assert held(opener)[-1] == (DRIVE_TELEOP, *asked), name
        assert len(opener.graph.asked(Hold)) == sum(map(len, keys.values()))
        word = opener.graph.asked(Hold)[0][2]
        assert word.until_s == STARTED_S + FIRST_HOLD_S
        assert word.rest["drive"] == {"speed": 0.0, "steering_angle": 0.0}
        await pilot.press("q", "x", "r", "X", "й", "c", "z")
        await pilot.pause()
        assert app.is_running
        assert opener.link.asked == []
        await pilot.press("plus", "plus", "minus", "right_square_bracket", "up", "a")
        assert held(opener)[-1] == (DRIVE_TELEOP, 0.25, 0.35)
        assert "0.25 m/s" in text_of(panel)
        assert "0.35 rad" in text_of(panel)


async def test_where_nobody_listens_nothing_is_held_and_it_says_why() -> None:
    deaf = tuple(replace(row, subscribers=0) for row in TOPICS)
    opener = opener_of(lesson_update(topics=deaf))
    async with driving(opener) as (_app, pilot, panel):
        await pilot.press("up")
        assert opener.graph.asked(Hold) == []
        assert "Nobody listens to /drive_teleop or /drive: nothing will move." in text_of(panel)


async def test_it_drives_by_the_lessons_topic_until_a_gate_comes() -> None:
    opener = RecordedOpener()
    async with driving(opener) as (_app, pilot, panel):
        assert str(panel.border_title).endswith("→ /drive")
        await pilot.press("up")
        assert held(opener) == [(DRIVE, 0.2, 0.0)]
        opener.graph.show(gated())
        await pilot.pause()
        assert opener.graph.asked(LetGo) == [(DRIVE,)]
        await pilot.press("up")
        assert [name for name, *_asked in held(opener)] == [DRIVE, DRIVE_TELEOP]


async def test_whatever_takes_the_keys_away_stops() -> None:
    opener = opener_of(gated())
    async with driving(opener) as (app, pilot, _panel):
        for leave, back in {
            "tab": (),
            "f1": ("escape",),
            "ctrl+p": ("escape",),
            "2": ("1",),
            "space": ("ctrl+r",),
            "escape": (),
            "е": (),
        }.items():
            await cast("LessonDeck", app.screen).open_teleop()
            await pilot.press("up")
            panel = app.screen.query_one(TeleopPanel)
            assert panel.asked.speed_m_s, leave
            before = len(opener.graph.asked(LetGo))
            await pilot.press(leave)
            await pilot.pause()
            assert set(opener.graph.asked(LetGo)[before:]) == {(DRIVE_TELEOP,)}, leave
            assert panel.asked.speed_m_s == 0, leave
            if leave == "tab":
                assert "the keyboard focus is elsewhere; t or a click" in text_of(panel)
            await pilot.press(*back)
            await pilot.pause()
            assert bool(app.screen.query(TeleopPanel)) == (leave not in {"escape", "е"})


async def test_a_terminal_that_loses_the_focus_stops() -> None:
    opener = opener_of(gated())
    async with driving(opener) as (app, pilot, panel):
        await pilot.press("up")
        app.post_message(events.AppBlur())
        await pilot.pause()
        assert opener.graph.asked(LetGo) == [(DRIVE_TELEOP,)]
        assert panel.asked.speed_m_s == 0
        app.post_message(events.AppFocus())
        await pilot.pause()
        assert panel.has_focus


async def test_the_end_of_the_session_takes_it_away() -> None:
    opener = opener_of(gated())
    async with driving(opener) as (app, pilot, _panel):
        await pilot.press("up")
        opener.link.say(ClosedEvent("gone"))
        await until(lambda: not app.screen.query(TeleopPanel), "the panel gone")
        assert opener.graph.asked(StopCommanding)


async def test_a_key_that_has_waited_too_long_moves_nothing() -> None:
    opener = opener_of(gated())
    async with driving(opener) as (_app, pilot, panel):
        late = events.Key("up", None)
        late.time = STARTED_S - FIRST_HOLD_S
        panel.post_message(late)
        await pilot.pause()
        assert opener.graph.asked(Hold) == []
        late = events.Key("up", None)
        late.time = STARTED_S - 0.4
        panel.post_message(late)
        await pilot.pause()
        assert opener.graph.asked(Hold)[0][2].until_s == pytest.approx(STARTED_S + 0.2)


async def test_a_key_that_may_have_been_typed_while_the_process_slept_moves_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def move_hand(to_s: float) -> None:
        monkeypatch.setattr(clock, "steady", lambda: to_s)

    opener = opener_of(gated())
    async with driving(opener) as (_app, pilot, panel):
        move_hand(STARTED_S + 0.4)
        panel.press(Move.FORWARD)
        assert len(opener.graph.asked(Hold)) == 1
        panel.release()
        # Read on waking, so stamped as if it were new: by then, or a moment later.
        woke_s = STARTED_S + 6.0
        move_hand(woke_s)
        await pilot.press("up")
        move_hand(woke_s + DRAIN_S - 0.1)
        await pilot.press("up")
        assert len(opener.graph.asked(Hold)) == 1
        # Handled later than that it is no newer.
        move_hand(woke_s + DRAIN_S + 0.1)
        panel.press(Move.FORWARD, woke_s + 0.2)
        assert len(opener.graph.asked(Hold)) == 1
        await pilot.press("up")
        assert len(opener.graph.asked(Hold)) == 2


async def test_while_stopped_the_keys_ask_for_nothing() -> None:
    opener = opener_of(gated())
    async with driving(opener) as (_app, pilot, panel):
        await pilot.press("space", "up")
        assert opener.graph.asked(Hold) == []
        now_s = clock.now()
        opener.graph.show(obeyed(word(GATE, True, now_s), at_s=now_s, topics=GATED))
        await pilot.pause()
        assert "emergency stop: nothing moves; ^r releases" in text_of(panel)
        await pilot.press("ctrl+r")
        now_s = clock.now()
        opener.graph.show(obeyed(word(GATE, False, now_s), at_s=now_s, topics=GATED))
        await pilot.pause()
        await pilot.press("up")
        assert len(opener.graph.asked(Hold)) == 1


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "the path is clear: 1.84 m ahead"),
        (
            {"front_m": "0.7", "allowed": "0.40", "source": "/drive", "ignored": "/x\x1b"},
            "slowed to 40 %: 0.70 m ahead · obeys /drive · ignores /x␛",
        ),
        (
            {"verdict": "blocked_forward", "front": "close", "front_m": "0.340", "allowed": "0.00"},
            "forward is blocked: obstacle 0.34 m ahead",
        ),
        (
            {"verdict": "blocked", "front": "invalid", "front_m": "nan", "rear": "silent"},
            "motion is blocked: no valid distance ahead, the rear sonar is silent",
        ),
        ({"verdict": "starting"}, "the gate is starting"),
    ],
)
def test_the_gate_is_told_in_the_screens_words(values: dict[str, str], words: str) -> None:
    gate = gate_in(safety(**values).value)
    assert gate is not None
    assert gate_words(gate) == words


SLOWED = safety(front_m="0.700", allowed="0.40", source="/drive_teleop")


async def test_during_a_cut_the_bar_shows_no_old_values_and_says_that_nothing_comes() -> None:
    opener = opener_of(gated())
    async with driving(opener) as (app, pilot, panel):
        assert "0.30 rad" in text_of(panel).splitlines()[4]
        silent = gated(time_s=NOW_S + 12)
        opener.graph.show(replace(silent, samples={}))
        await pilot.pause()
        shown = text_of(panel)
        assert "the gate has been silent for 12 s" in shown
        assert "12 s ago" in shown.splitlines()[4]
        assert "0.30 rad" not in shown.splitlines()[4]
        app.emergency.engage()
        await pilot.pause()
        assert "pressed, nobody has confirmed it" in text_of(panel)
        assert "nothing moves" not in text_of(panel)
