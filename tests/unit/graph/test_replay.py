"""A bag played back with no ROS: its pace, its rates, its jumps, and what it refuses."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from rosbags.rosbag2 import StoragePlugin

from graph.data import GraphUpdate, Interest, Sample, TopicRow
from graph.observer.requests import CallService, Publish, ReadParameters, SendGoal, SetParameters, StartPublishing
from graph.replay.replay import Replay
from tests.unit.bags import write_bag
from tests.waiting import wait_until


class Viewer:
    """A replay and all that it has handed over."""

    def __init__(self, path: Path, **settings: Any) -> None:
        self.replay = Replay(path, **settings)
        self.want()
        self.update = GraphUpdate(0.0)
        self.samples: dict[str, list[Sample]] = {}

    def want(self, **topics: frozenset[str]) -> None:
        self.replay.want(Interest(**topics, period_s=0.02))  # type: ignore[arg-type]

    def start(self) -> None:
        self.replay.start(self._take)

    def row(self, topic: str) -> TopicRow:
        return next(row for row in self.update.topics if row.name == topic)

    def values(self, topic: str) -> list[Any]:
        return [sample.value["data"] for sample in self.samples.get(topic, [])]

    def wait(self, condition: Callable[[], Any], what: str) -> None:
        wait_until(condition, what)

    def _take(self, update: GraphUpdate) -> None:
        self.update = update
        for topic, samples in update.samples.items():
            self.samples.setdefault(topic, []).extend(samples)


@pytest.fixture(params=[StoragePlugin.MCAP, StoragePlugin.SQLITE3], ids=["mcap", "sqlite3"])
def bag(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    return write_bag(tmp_path / "walk", storage=request.param)


@pytest.fixture
def viewer(bag: Path) -> Iterator[Viewer]:
    made = Viewer(bag, rate=10.0)
    yield made
    made.replay.stop()


def test_every_message_is_handed_over_once_and_in_order(viewer: Viewer) -> None:
    viewer.want(followed=frozenset({"/number"}))
    viewer.start()
    viewer.wait(lambda: viewer.replay.state.ended, "the end")
    viewer.wait(lambda: len(viewer.values("/number")) == 101, "all messages")
    assert viewer.values("/number") == [float(n) for n in range(101)]
    assert viewer.replay.state.paused
    assert viewer.replay.state.position_s == viewer.replay.state.length_s == 10.0


def test_it_pauses_steps_and_goes_on(viewer: Viewer) -> None:
    viewer.replay.toggle()
    viewer.want(watched=frozenset({"/number"}))
    viewer.start()
    viewer.wait(lambda: viewer.values("/number") == [0.0], "the first message")
    viewer.replay.step()
    viewer.wait(lambda: viewer.values("/number") == [0.0, 1.0], "one step")
    viewer.replay.step()
    viewer.wait(lambda: viewer.values("/number") == [0.0, 1.0, 2.0], "another step")
    assert viewer.replay.state.paused
    assert viewer.replay.state.position_s == pytest.approx(0.2)
    viewer.replay.toggle()
    viewer.wait(lambda: viewer.replay.state.ended, "the end")


def test_a_jump_shows_the_message_and_the_rate_of_that_place(viewer: Viewer) -> None:
    viewer.replay.toggle()
    viewer.want(watched=frozenset({"/number", "/map_name"}))
    viewer.start()
    viewer.replay.seek(7.0)
    viewer.wait(lambda: viewer.values("/number")[-1:] == [70.0], "the message at seven seconds")
    assert viewer.row("/number").hz == pytest.approx(10.0, rel=0.02)
    assert viewer.values("/map_name")[-1] == "kitchen"
    viewer.replay.skip(-5.0)
    viewer.wait(lambda: viewer.values("/number")[-1] == 20.0, "the message at two seconds")
    viewer.replay.skip(-50.0)
    viewer.wait(lambda: viewer.replay.state.position_s == 0.0, "the beginning")


def test_a_latched_message_from_long_before_is_there_after_a_jump(bag: Path) -> None:
    viewer = Viewer(bag, start_s=9.0)
    viewer.want(watched=frozenset({"/map_name"}))
    viewer.replay.toggle()
    viewer.start()
    viewer.wait(lambda: viewer.values("/map_name") == ["kitchen"], "the latched message")
    viewer.replay.stop()


def test_nothing_can_be_published_called_or_set(viewer: Viewer) -> None:
    viewer.start()
    for future in (
        viewer.replay.ask(Publish("/x", "std_msgs/msg/String", {})),
        viewer.replay.ask(StartPublishing("/x", "std_msgs/msg/String", {}, 1.0)),
        viewer.replay.ask(SendGoal("/x", "y", {})),
    ):
        with pytest.raises(Exception, match="this is a recording"):
            future.result(1)
    assert "this is a recording" in viewer.replay.ask(CallService("/x", "y", {})).result(1).error
    assert "this is a recording" in viewer.replay.ask(ReadParameters("/x")).result(1).error
    assert "this is a recording" in viewer.replay.ask(SetParameters("/x", {})).result(1).error
