"""How twelve screens look, at 80x24 in English and at 120x40 in Russian, and panels, once each."""

from __future__ import annotations

import math
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Static

from course.judging import ValuesDrawn
from graph.data import GraphUpdate, Sample, Trouble
from launcher.events import LogEvent
from tests.tui import recorded_devices, recorded_flow
from tests.tui.composer.test_composer import PARSER
from tests.tui.composer.test_outcome import drive, head, result, wheels
from tests.tui.lesson.test_lesson import SEED, SEEN, own_opener
from tests.tui.panel_stage import Placed, Stage
from tests.tui.panels.test_drawings import turning
from tests.tui.panels.test_voice import tone
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, RecordedSession, lesson_update, topic
from tests.tui.recorded_brain import BRAIN_STATE, TYPE, brain_state
from tests.tui.recorded_frames import with_frames
from tests.tui.recorded_map import MAP_SESSION, map_update
from tests.tui.recorded_nodes import graph_update
from tests.tui.replayed import BagOpener
from tests.tui.snapshots import NARROW, WIDE, Look, SnapCompare, seen, settle
from tests.tui.space.stage_runs import robot_in_a_room
from tests.tui.teleop.test_teleop import SLOWED, gated, opener_of
from tests.tui.topics_stage import CAMERA, depth_message, with_camera
from tests.unit.bags import write_robot_bag
from tests.waiting import until
from tui import clock
from tui.app import DeckApp
from tui.composer.screen import ComposerScreen
from tui.devices import drivers
from tui.frame.key_bar import KeyBar
from tui.frame.title_bar import TitleBar
from tui.graph.index import GraphKind, GraphPlace
from tui.graph.screen import GraphScreen
from tui.panels.brain import BrainPanel
from tui.panels.head import HeadReading, HeadView
from tui.panels.sonar import Sonar
from tui.panels.voice import VoiceView
from tui.panels.wheels import WheelsView
from tui.session.requests import OpenRequest, ReplayRequest
from tui.topics.publish import PublishDialog
from tui.topics.screen import TopicsScreen


@dataclass
class At:
    """An app under a pilot, for what has to happen before one looks."""

    app: DeckApp
    pilot: Pilot[Any]
    opener: RecordedOpener
    language: str

    async def show(self, update: GraphUpdate) -> None:
        self.opener.graph.show(update)
        await self.pause()

    async def press(self, *keys: str) -> None:
        await self.pilot.press(*keys)
        await self.pause()

    async def pause(self) -> None:
        for _round in range(4):
            await self.pilot.pause()


async def nothing(_at: At) -> None:
    """It is seen as it opens."""


async def lesson(at: At) -> None:
    """Text, the check with what was seen and where to look, file and fault; not yet passed."""
    judge = at.opener.judged
    await until(lambda: judge.asked, "the first step to be judged")
    judge.say(ValuesDrawn(SEED))
    judge.say(SEEN)
    await until(lambda: "→" in seen(at.app), "the result")


async def topics(at: At) -> None:
    """Topics with rates; /drive is chosen and stands as a tree: speed 0.3, steering 0.5."""
    await chosen(at, "/drive", lesson_update())


async def chosen(at: At, name: str, update: GraphUpdate) -> None:
    assert isinstance(at.app.screen, TopicsScreen)
    at.app.screen.table.choose(name)
    await at.pilot.pause()
    await at.show(update)


async def graph(at: At) -> None:
    """Nodes at the left; safety_stop with its process, what it says and hears, and with whom."""
    screen = at.app.screen
    assert isinstance(screen, GraphScreen)
    await screen.go(GraphPlace(GraphKind.NODE, "/safety_stop"))
    await until(lambda: not screen.is_settling, "a screen at rest")


async def composer(at: At) -> None:
    """The example in colour, valid; what came of it in order of time, each with its delay."""
    await at.press("ctrl+s")
    came = (
        (0.012, result(event="accepted", commands=2, thought="Something moved on the right.")),
        (0.015, drive("/drive", 0.2, -0.3)),
        (0.019, drive("/drive_safe", 0.2, -0.3)),
        (0.031, wheels(6.36, 5.75)),
        (0.4, head(-0.4, 0.1)),
        (1.03, head(-0.7854, 0.1745)),
        (1.043, result(event="head", pan=-45, tilt=10, sum=1)),
    )
    samples: dict[str, tuple[Sample, ...]] = {}
    for after_s, one in came:
        arrived = replace(one, received_s=clock.now() + after_s)
        samples[one.topic] = (*samples.get(one.topic, ()), arrived)
    await at.show(lesson_update(topics=(*lesson_update().topics, PARSER), samples=samples))


async def flow(at: At) -> None:
    """From the microphone to wheels and head, each with its delay and a bar on an axis of time."""
    at.opener.graph.show(recorded_flow.update(*recorded_flow.voice(0.0)))
    at.opener.link.say(LogEvent(recorded_flow.voice_lines(0.0)))


async def devices(at: At) -> None:
    """Four drivers, each with its state; drive lines out and telemetry in, noise and a bad line."""
    frames = recorded_devices.of_chassis(language=at.language)
    await at.show(recorded_devices.update(*recorded_devices.STATUSES, frames))


async def frames(at: At) -> None:
    """The tree with rates and publishers, the camera relative to odom, nothing wrong."""
    await at.press("down", "down")


async def teleop(at: At) -> None:
    """Asked 0.20 m/s in a left curve, 0.08 allowed: slowed to 40 %, said in words; limits below."""
    await at.press("t", "up", "left")


async def depth(at: At) -> None:
    await chosen(at, CAMERA, with_camera("sensor_msgs/msg/Image", depth_message()))
    await at.show(with_camera("sensor_msgs/msg/Image", depth_message()))


async def plot(at: At) -> None:
    """A wave with a gap, its letter, its range and its marks."""
    await chosen(at, SONAR, lesson_update())
    await at.press("V")
    for quarter in range(112):
        at_s = quarter / 4
        metres = math.nan if 8 <= at_s < 10 else 1.5 + math.sin(at_s)
        one = replace(lesson_update().samples[SONAR][0], value={"data": metres})
        wave = replace(one, received_s=NOW_S + at_s)
        at.opener.graph.show(lesson_update(time_s=NOW_S + at_s + 0.25, samples={SONAR: (wave,)}))
        await at.pilot.pause()


async def publish(at: At) -> None:
    """Topic and type, every field of the type with its default, and that nothing is wrong."""
    await topics(at)
    await at.press("P")
    dialog = at.app.screen
    assert isinstance(dialog, PublishDialog)
    await until(lambda: dialog.form.value is not None, "a form that is right")


def with_parser() -> RecordedOpener:
    rows = (*lesson_update().topics, PARSER)
    return RecordedOpener(graph=RecordedGraph(update=lesson_update(topics=rows)))


def before_speech() -> RecordedOpener:
    update = recorded_flow.update(*recorded_flow.BEFORE)
    return RecordedOpener(RecordedSession(lines=()), RecordedGraph(update))


def with_map() -> RecordedOpener:
    return RecordedOpener(RecordedSession(MAP_SESSION), RecordedGraph(map_update()))


def nodes() -> RecordedOpener:
    return RecordedOpener(graph=RecordedGraph(update=graph_update()))


SONAR = "/sensor/sonar_front"
Scene = tuple[str, Callable[[], RecordedOpener], Callable[[At], Awaitable[None]]]
SCREENS: dict[str, Scene] = {
    "picker": ("picker", RecordedOpener, nothing),
    "deck": ("deck", RecordedOpener, nothing),
    "lesson": ("lesson", lambda: own_opener(kind="crash"), lesson),
    "topics": ("topics", RecordedOpener, topics),
    "graph": ("graph", nodes, graph),
    "logs": ("logs", RecordedOpener, nothing),
    "composer": ("composer", with_parser, composer),
    "flow": ("flow", before_speech, flow),
    "devices": ("devices", recorded_devices.with_drivers, devices),
    "frames": ("frames", with_frames, frames),
    "space": ("space", robot_in_a_room, nothing),
    "teleop": ("deck", lambda: opener_of(gated(SLOWED)), teleop),
}
PARTS: dict[str, Scene] = {
    "map": ("deck", with_map, nothing),
    "wall": ("wall", RecordedOpener, nothing),
    "depth": ("topics", RecordedOpener, depth),
    "plot": ("topics", RecordedOpener, plot),
    "publish": ("topics", RecordedOpener, publish),
}


@pytest.fixture(autouse=True)
def _everywhere_the_same(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Folders of nobody, a clock that stands, and no budget that goes by another."""
    for name in ("DECK_COURSE", "XDG_STATE_HOME", "XDG_CACHE_HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    monkeypatch.setattr(drivers, "lessons_with_drivers", lambda: ("robot",))
    monkeypatch.setattr(clock, "steady", lambda: 1.0)
    monkeypatch.setattr(ComposerScreen, "_show_budget", lambda _screen: None)


def staged(scene: Scene, look: Look) -> tuple[DeckApp, Callable[[Pilot[Any]], Awaitable[None]]]:
    """Return the app, and what is to be done before one looks."""
    screen, opener_of_it, act = scene
    opener = opener_of_it()
    app = look.app(screen, opener)

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        at = At(app, pilot, opener, look.language)
        await act(at)
        await at.pause()

    return app, before


@pytest.mark.parametrize("look", [NARROW, WIDE], ids=str)
@pytest.mark.parametrize("name", SCREENS)
def test_a_screen(name: str, look: Look, snap_compare: SnapCompare) -> None:
    app, before = staged(SCREENS[name], look)
    assert snap_compare(app, terminal_size=look.size, run_before=before)


@pytest.mark.parametrize("name", PARTS)
def test_a_part(name: str, snap_compare: SnapCompare) -> None:
    app, before = staged(PARTS[name], NARROW)
    assert snap_compare(app, terminal_size=NARROW.size, run_before=before)


@pytest.mark.nightly
@pytest.mark.parametrize("name", sorted({*SCREENS, "wall", "plot", "publish"} - {"composer", "devices", "space"}))
async def test_a_change_of_language_leaves_a_screen_as_it_is_in_the_other(name: str) -> None:
    """Left out is what shows data that are in a language themselves, or a rate until the clock goes on."""
    scene = {**SCREENS, **PARTS}[name]
    whole: list[str] = []
    for first in ("ru", "en"):
        app, before = staged(scene, replace(WIDE, language=first))
        async with app.run_test(size=WIDE.size) as pilot:
            await before(pilot)
            app.speak("ru")
            await settle(pilot)
            whole.append(seen(app))
    assert whole[1] == whole[0]


def test_a_replay(tmp_path: Path, snap_compare: SnapCompare) -> None:
    """At the middle of a recording: the bar with place, length and rate; panels as they were."""
    bag = write_robot_bag(tmp_path / "drive")
    app = DeckApp(BagOpener(position_s=6.0), OpenRequest(replay=ReplayRequest(bag)))
    assert snap_compare(app, terminal_size=NARROW.size, run_before=settle)


def sonars() -> list[list[Placed]]:
    """FREE, CLOSE, STOP and BLIND by word and colour; one that is stale is grey."""
    gauges = [Sonar("front") for _gauge in range(6)]
    for gauge, metres in zip(gauges, (1.84, 0.72, 0.38, math.inf, math.nan, 1.2), strict=True):
        for second in range(60):
            gauge.show(0.3 + 2.7 * abs(math.sin(second / 5)), float(second))
        gauge.show(metres, 60.0)
    gauges[5].show_trouble(Trouble.QUIET, "", 3.4)
    places = zip(gauges, ((34, 12), (34, 7), (34, 3), (38, 8), (38, 8), (38, 4)), strict=True)
    column: list[Placed] = list(places)
    return [column[:3], column[3:]]


def wheels_seen() -> list[list[Placed]]:
    """Wheels turned as steered, a longer bar for the faster wheel, downwards when backwards."""
    views = [WheelsView() for _view in range(4)]
    for view, (speed, steering) in zip(views, ((0.3, 0.5), (-0.3, -0.5), (0.5, 0.0), (0.0, 0.2)), strict=True):
        view.show(turning(speed, steering))
    views[3].show_trouble(Trouble.QUIET, "", 5.0)
    return [[(views[0], (46, 14)), (views[1], (46, 10))], [(views[2], (36, 5)), (views[3], (36, 9))]]


def heads() -> list[list[Placed]]:
    """A needle on half a circle from above and from the side, a stroke where it was told to be."""
    views = [HeadView() for _view in range(3)]
    for view, pose in zip(views, ((45, 10), (-90, -45), (0, 0)), strict=True):
        view.show(HeadReading(*pose))
    views[0].command(HeadReading(60, 20))
    views[2].show_trouble(Trouble.QUIET, "", 5.0)
    return [[(views[0], (44, 14)), (views[1], (44, 8))], [(views[2], (40, 10))]]


def voices() -> list[list[Placed]]:
    """Human and robot by name, sign and colour; text folded; sound as a line of levels."""
    views = [VoiceView() for _view in range(2)]
    for view in views:
        view.hear("human", b"VOICE_COMMAND: Look around and tell me what you see!", NOW_S)
        view.hear("robot", "Еду вперёд и осматриваюсь".encode(), NOW_S + 2)
        view.hear("human", tone(0.5, 0.3), NOW_S + 5)
        view.show_level(-24.0)
    return [[(views[0], (60, 10))], [(views[1], (28, 10))]]


def brains() -> list[list[Placed]]:
    """What the brain does, what its answers take, and what is left of the budget."""
    panel = BrainPanel()
    row = topic(BRAIN_STATE, TYPE, hz=1.0)
    update = lesson_update(topics=(row,), samples={BRAIN_STATE: (brain_state(),)})
    panel.call_later(panel.show, update)
    return [[(panel, (60, 6))]]


PANELS = {"sonar": sonars, "wheels": wheels_seen, "head": heads, "voice": voices, "brain": brains}


@pytest.mark.parametrize("name", PANELS)
def test_a_panel(name: str, snap_compare: SnapCompare) -> None:
    stage = Stage(*PANELS[name]())
    assert snap_compare(stage, terminal_size=(96, 30), run_before=stage.filled)


@pytest.mark.parametrize("name", SCREENS)
async def test_in_russian_nothing_is_cut_at_80x24(name: str) -> None:
    """No words for want of lines, no tab of the title, and of the keys none that matters."""
    app, before = staged(SCREENS[name], Look((80, 24), "ru"))
    async with app.run_test(size=(80, 24)) as pilot:
        await before(pilot)
        for part in app.screen.query(Static):
            width, height = part.content_size
            if part.visible and width and part.is_on_screen:
                needed = part.visual.get_height(part.styles.get_rules(), width)
                assert needed <= height, f"{part}: {part.content}"
        keys = str(app.screen.query_one(KeyBar).render())
        title = app.screen.query_one(TitleBar).text
    plain = keys.replace("^q", "q").strip().split("  ")
    assert {"f1 Справка", "^p Палитра", "q Выход"} <= set(plain)
    if name != "picker":
        assert "СТОП" in keys
        assert "домен 42" in title
        assert all(f" {tab} " in title for tab in "1L23456789")
