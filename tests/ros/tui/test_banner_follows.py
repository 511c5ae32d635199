"""The banner shows what the nodes obey, whoever has said what and has gone again."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from std_msgs.msg import Bool

from graph.data import Interest
from graph.observer.observer import Observer
from launcher.client.stop_road import StopRoad
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import until
from tui.emergency.control import EmergencyControl
from tui.emergency.state import FOLLOWED, listeners
from tui.emergency.words import stop_words
from tui.session.past import GraphInbox

WITHIN_S = 30.0
NODE = "/electronic_differential"


class Screen:
    """As much of the app as the emergency stop needs, on a graph that is really observed."""

    def __init__(self, domain: int, folder: Path) -> None:
        """`folder` has no supervisor's socket: the road writes itself."""
        self._inbox = GraphInbox(lambda: None)
        link = SimpleNamespace(emergency_stop=StopRoad(folder, domain))
        self.observer = Observer(domain, "localhost")
        self.feed = SimpleNamespace(graph=self.observer, update=None, link=link, nodes={}, watching=True, replay=None)
        self.notes: list[str] = []
        self.emergency = EmergencyControl(cast("Any", self), cast("Any", self.feed), lambda: None)
        self._workers: list[asyncio.Future[Any]] = []
        self.observer.start(self._inbox.put)
        self.observer.want(Interest(followed=frozenset(FOLLOWED)))
        self.emergency.prepare()

    @property
    def words(self) -> str:
        """The banner, empty if there is none."""
        state = self.emergency.state
        return stop_words(state, "^r")[0] if state.engaged else ""

    async def until(self, condition: Callable[[], object], what: str) -> None:
        """Take in what comes until the condition holds."""

        def held() -> object:
            update = self._inbox.take()
            if update is not None:
                self.feed.update = update
                self.emergency.see(update)
            return condition()

        await until(held, lambda: f"{what}; {self.emergency.state}", WITHIN_S)

    def says(self, engaged: bool) -> bool:
        node = self.emergency.state.nodes.get(NODE)
        return node is not None and node.engaged == engaged

    def run_worker(self, work: Any, group: str) -> None:
        assert group == "emergency"
        self._workers.append(asyncio.ensure_future(work))

    def notify(self, words: str, **_looks: Any) -> None:
        self.notes.append(words)

    async def close(self) -> None:
        await asyncio.gather(*self._workers)
        self.observer.stop()


@pytest.fixture
async def screen(ros_domain: int, tmp_path: Path) -> AsyncIterator[Screen]:
    """A screen that only watches."""
    screen = Screen(ros_domain, tmp_path)
    yield screen
    await screen.close()


async def test_a_volatile_word_of_one_who_leaves_stops_and_releases(screen: Screen, ros_domain: int) -> None:
    """No gate is there to tell of it, and nobody whose word is latched."""
    with NodeProcess("nodes.electronic_differential", ros_domain):
        await screen.until(lambda: screen.says(False), "the node's word")
        screen.emergency.engage()
        await screen.until(lambda: screen.says(True), "the stop")
        assert screen.words.startswith("■ EMERGENCY STOP since ")
        with Peer(ros_domain, "passer_by") as other, other.saying("/emergency_stop", Bool(data=False)):
            await screen.until(lambda: screen.says(False), "the release")
        await screen.until(lambda: not screen.words, "no banner over wheels that may turn")
        assert any("released elsewhere" in note for note in screen.notes)
        # Once: who keeps saying it is not overruled within half a second of the last word.
        with Peer(ros_domain, "joy") as joy:
            joy.say("/emergency_stop", Bool(data=True), listeners=2)
            await screen.until(lambda: "(by joy)" in screen.words, "the foreign stop, by name")
        screen.emergency.release()
        await screen.until(lambda: not screen.words and screen.says(False), "our release")


async def test_a_stop_that_only_the_screen_has_heard_is_passed_on_and_shown(screen: Screen, ros_domain: int) -> None:
    """By a publisher that was gone before the node found it."""
    deaf = ("--ros-args", "-r", "/emergency_stop:=/nobody_says")
    with NodeProcess("nodes.electronic_differential", ros_domain, arguments=deaf):
        await screen.until(lambda: screen.says(False), "the node's word")
        # Of somebody who listens to the stop, as the road is for a robot that obeys one.
        with NodeProcess("nodes.ai_brain", ros_domain) as another, Peer(ros_domain, "joy") as joy:
            await screen.until(lambda: listeners(screen.feed.update), "who listens")
            publisher = joy.publisher("/emergency_stop", Bool)
            await screen.until(lambda: publisher.get_subscription_count() >= 2, "who hears it")
            another.send(signal.SIGSTOP)
            publisher.publish(Bool(data=True))
            await screen.until(lambda: screen.says(True), "the stop")
            assert "EMERGENCY STOP" in screen.words
            another.send(signal.SIGCONT)
        screen.emergency.release()
        await screen.until(lambda: not screen.words and screen.says(False), "the release")


async def test_a_node_that_hangs_is_named_until_it_has_heard_of_the_release(screen: Screen, ros_domain: int) -> None:
    with (
        NodeProcess("nodes.electronic_differential", ros_domain) as node,
        NodeProcess("nodes.safety_stop", ros_domain),
    ):
        await screen.until(lambda: len(screen.emergency.state.nodes) == 2, "both nodes")
        screen.emergency.engage()
        await screen.until(lambda: len(screen.emergency.state.holders) == 2, "the stop")
        node.send(signal.SIGSTOP)
        screen.emergency.release()
        held = "released here, still held by electronic_differential"
        await screen.until(lambda: held in screen.words, "who has not released it")
        node.send(signal.SIGCONT)
        await screen.until(lambda: not screen.words, "the release")
