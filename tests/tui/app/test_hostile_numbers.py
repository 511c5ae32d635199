"""Whatever is sent is shown somehow: no number or text ends a panel, a screen or the stop."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from graph.data import GraphUpdate, Sample
from launcher.events import LogEvent, StatusEvent
from launcher.status import LogLine, NodeStatus
from robot.motion.odometry import yaw_from_quaternion
from tests.tui import strategies
from tests.tui.app_runs import opened
from tests.tui.recorded import SESSION, RecordedGraph, RecordedOpener, RecordedSession
from text.figures import elapsed, figure, short, whole
from tui.clock import time_of_day
from tui.frame.screen import DeckScreen
from tui.outcome.view import delay_text
from tui.panels.head.reading import HeadReading, head_in
from tui.panels.head.widget import HeadView
from tui.panels.map.reading import goal_in, occupancy_in, pose_in
from tui.panels.map.widget import RoomMap
from tui.panels.registry import PANELS
from tui.panels.sonar.widget import Sonar
from tui.panels.voice.widget import VoiceView
from tui.panels.wheels.panel import would_be
from tui.panels.wheels.reading import wheels_in
from tui.panels.wheels.widget import WheelsView, angle_words, radius_words, speed_words
from tui.topics.plot.field import PlotField
from tui.topics.plot.legend import number_text
from tui.topics.plot.plot import TopicPlot
from tui.topics.table.columns import age_text, bandwidth_text, hz_text
from tui.widgets.drawing import Drawing
from tui.widgets.figures import count_text, seconds_text
from tui.widgets.node_words import duration, memory, percent
from tui.widgets.trouble import no_data_words

pytestmark = pytest.mark.nightly

Said = tuple[GraphUpdate, tuple[NodeStatus, ...], tuple[LogLine, ...]]
SIZES = ((1, 1), (12, 2), (34, 5), (44, 14), (120, 40))
ALL_PANELS = tuple(PANELS)
SCREENS = ("deck", "topics", "composer", "logs", "graph", "flow", "devices")
LOOKS = 16
LONGEST = 24
"""Cells of a figure with its unit, whatever it is."""

quick = settings(max_examples=60, deadline=None, derandomize=True, database=None)


def drawn(view: Drawing) -> None:
    """Draw it as the screen would, at every size that it has another drawing for."""
    for width, height in SIZES:
        for line in view.draw(width, height):
            assert all(isinstance(ink.text, str) for ink in line)


def message(topic: str) -> st.SearchStrategy[Any]:
    return strategies.MESSAGES[topic][1]


@quick
@given(message("/wheel_commands"), message("/drive"))
def test_wheels_are_drawn(joints: Any, drive: Any) -> None:
    for wheels in (wheels_in(joints), would_be(drive)):
        view = WheelsView()
        if wheels is not None:
            view.show(wheels)
        drawn(view)


@quick
@given(st.lists(st.tuples(strategies.doubles, strategies.doubles), min_size=1, max_size=5))
def test_distances_are_drawn(readings: list[tuple[float, float]]) -> None:
    view = Sonar("front")
    for metres, time_s in readings:
        view.show(metres, time_s)
        drawn(view)


@quick
@given(
    message("/head_state"),
    st.builds(HeadReading, strategies.doubles, strategies.doubles),
    strategies.texts,
)
def test_heads_are_drawn(state: Any, told: HeadReading, answer: str) -> None:
    view = HeadView()
    pose = head_in(state)
    for one in filter(None, (pose, told, pose)):
        view.show(one)
        view.command(told)
        view.answer(answer)
        drawn(view)


places = strategies.pose_stamped | strategies.odometry
"""Anywhere."""
near = st.floats(-20, 20) | strategies.doubles


@quick
@given(
    st.lists(places, max_size=3),
    message("/map"),
    message("/goal_pose"),
    st.lists(near, min_size=2, max_size=4),
)
def test_maps_are_drawn(poses: list[Any], room: Any, goal: Any, rays: list[float]) -> None:
    view = RoomMap()
    usual = {"position": {"x": 1.0, "y": 2.0, "z": 0.0}, "orientation": dict.fromkeys("xyzw", 0.5)}
    for pose in ({"header": {"frame_id": "odom"}, "pose": usual}, *poses):
        found = pose_in(pose)
        if found is not None:
            view.show_pose(*found)
            view.show_truth(found[0])
        occupancy = occupancy_in(room)
        if occupancy is not None:
            view.show_occupancy(occupancy)
        view.show_goal(goal_in(goal))
        for place, metres in zip(("front", "rear"), rays, strict=False):
            view.show_ray(place, metres)
        view.settle()
        drawn(view)


def test_one_reading_of_a_sonar_does_not_make_the_map_useless() -> None:
    view = RoomMap()
    found = pose_in(
        {
            "header": {"frame_id": "odom"},
            "pose": {
                "position": {"x": 0.0, "y": 0.0, "z": 0.0},
                "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
            },
        }
    )
    assert found is not None
    view.show_pose(*found)
    view.show_ray("front", 3.4e38)
    view.settle()
    view.draw(60, 20)
    assert view._view is not None
    assert view._view.columns / view._view.dots_per_m < 100


@quick
@given(strategies.turn)
def test_a_heading_is_a_number_or_none(turn: dict[str, float]) -> None:
    heading = yaw_from_quaternion(*(turn[axis] for axis in "xyzw"))
    assert math.isnan(heading) or abs(heading) <= math.pi


@quick
@given(
    st.lists(st.tuples(message("/audio/mic_raw"), strategies.doubles), max_size=4), strategies.maybe
)
def test_voices_are_drawn(said: list[tuple[Any, float]], level: float | None) -> None:
    view = VoiceView()
    for one, time_s in said:
        view.hear("human", one["data"], time_s)
        view.show_level(level)
        drawn(view)


@quick
@given(st.lists(st.tuples(strategies.doubles, near), min_size=1, max_size=12), st.integers(0, 3))
def test_plots_are_drawn(points: list[tuple[float, float]], windows: int) -> None:
    plot = TopicPlot()
    plot.toggle(PlotField("/number", ("data",)))
    now_s = 1_767_225_600.0
    for number, ahead_s in points:
        now_s += abs(ahead_s) if abs(ahead_s) < 1e6 else 0.1
        sample = Sample("/number", "std_msgs/msg/Float64", now_s, 0.0, 8, {"data": number})
        plot.take(GraphUpdate(now_s, samples={"/number": (sample,)}))
    for _each in range(windows):
        plot.next_window()
    drawn(plot)


WORDS: Sequence[Callable[[float], str]] = (
    age_text,
    angle_words,
    bandwidth_text,
    delay_text,
    duration,
    elapsed,
    figure,
    hz_text,
    no_data_words,
    number_text,
    percent,
    radius_words,
    seconds_text,
    short,
    speed_words,
    time_of_day,
    whole,
)


@pytest.mark.parametrize("words", WORDS, ids=lambda words: words.__name__)
def test_a_figure_is_short_whatever_it_is(words: Callable[[float], str]) -> None:
    @quick
    @given(strategies.doubles)
    def check(value: float) -> None:
        assert 0 < len(words(value)) <= LONGEST + 8

    check()


@quick
@given(strategies.counts)
def test_a_count_is_short_whatever_it_is(count: int) -> None:
    assert len(count_text(count)) <= LONGEST
    assert len(memory(count)) <= LONGEST


async def shown(screen: str, said: list[Said]) -> None:
    """Show all of it on a screen that lets every exception out; the stop works to the end."""
    graph = RecordedGraph()
    session = RecordedSession(replace(SESSION, panels=ALL_PANELS))
    async with opened(RecordedOpener(session, graph), screen) as (app, pilot):
        for number, (update, statuses, lines) in enumerate(said):
            session.say(StatusEvent(statuses))
            session.say(LogEvent(lines))
            graph.show(update)
            await pilot.pause()
            if number == 2:
                await pilot.resize_terminal(80, 24)
        assert isinstance(app.screen, DeckScreen)
        assert app.screen.tab == screen
        assert any(strip.text.strip() for strip in app.screen._compositor.render_strips())
        graph.published.clear()
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert ("/emergency_stop", {"data": True}) in [(one[0], one[2]) for one in graph.published]


@cache
def everything_said() -> list[Said]:
    """A few looks at the graph and the session: an app for each of them would take a minute."""
    said: list[Said] = []

    @settings(quick, max_examples=LOOKS, suppress_health_check=list(HealthCheck))
    @given(strategies.updates(), strategies.statuses(), strategies.lines)
    def collect(
        update: GraphUpdate, statuses: tuple[NodeStatus, ...], lines: tuple[LogLine, ...]
    ) -> None:
        said.append((update, statuses, lines))

    collect()
    return said


@pytest.mark.parametrize("screen", SCREENS)
async def test_a_screen_shows_it_and_the_stop_works(screen: str) -> None:
    await shown(screen, everything_said())
