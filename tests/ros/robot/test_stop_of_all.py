"""A stop that one node has heard is a stop of all, and so is a release: by topic and by disk.

Nodes that cannot hear /emergency_stop stand for those that the middleware has not matched yet.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections import Counter
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool

from safety.known_stops import LATE_NS
from tests.ros.node_process import NodeProcess
from tests.ros.peer import DISCOVERY, LATCHED, ROOT, Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

LATCHED_OF_MANY = QoSProfile(depth=64, durability=DurabilityPolicy.TRANSIENT_LOCAL)
STOP, STATE = "/emergency_stop", "/emergency_stop_state"
DEAF = ("-r", f"{STOP}:=/nobody_says")
ALONE = (*DEAF, "-r", f"{STATE}:=/nobody_hears")
BARE = """
import sys, time, rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool
rclpy.init()
node = rclpy.create_node("bare")
qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
publisher = node.create_publisher(Bool, "/emergency_stop", qos)
while not publisher.get_subscription_count():
    time.sleep(0.001)
publisher.publish(Bool(data=sys.argv[1] == "true"))
time.sleep(0.1)
node.destroy_node()
rclpy.shutdown()
"""
"""As `ros2 topic pub --once` of ROS itself: it waits for one, and lives 0.1 s after that."""


def dict_of(status: DiagnosticStatus) -> dict[str, str]:
    return {pair.key: pair.value for pair in status.values}


class States:
    """What each node says of its stop, and when it said so first."""

    def __init__(self, peer: Peer) -> None:
        self.of: dict[str, dict[str, str]] = {}
        self.when: dict[tuple[str, str], float] = {}
        self._topic = peer.node.create_subscription(DiagnosticArray, STATE, self._hear, LATCHED_OF_MANY)

    def _hear(self, message: DiagnosticArray) -> None:
        for status in message.status:
            values = dict_of(status)
            if self.of.get(status.name, {}).get("engaged") != values["engaged"]:
                self.when[status.name, values["engaged"]] = time.monotonic()
            self.of[status.name] = values

    def engaged(self, *names: str) -> set[str]:
        return {self.of.get(name, {}).get("engaged", "") for name in names}

    def agree(self, word: str, *names: str) -> bool:
        return self.engaged(*names) == {word}

    def wait(self, engaged: bool, *names: str) -> None:
        word = str(engaged).lower()
        wait_until(lambda: self.agree(word, *names), f"engaged {engaged} from {names}")


def node(domain: int, name: str, *remaps: str, module: str = "electronic_differential") -> NodeProcess:
    arguments = ("--ros-args", "-r", f"__node:={name}", *remaps)
    return NodeProcess(f"nodes.{module}", domain, arguments=arguments)


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain) as peer:
        yield peer


@pytest.fixture
def states(peer: Peer) -> States:
    return States(peer)


def stop_file(domain: int) -> Path:
    return Path(os.environ["DECK_STATE_DIR"], "stops", str(domain))


def test_who_cannot_hear_it_takes_it_from_the_state_of_another(
    ros_domain: int, peer: Peer, states: States, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with node(ros_domain, "hears"):
        monkeypatch.setenv("DECK_STATE_DIR", str(tmp_path / "another_computer"))
        with node(ros_domain, "deaf", *DEAF, module="drive_to_point"):
            states.wait(False, "/hears", "/deaf")
            peer.say(STOP, Bool(data=True), qos=LATCHED, listeners=2)
            states.wait(True, "/hears", "/deaf")
            peer.say(STOP, Bool(data=False), qos=LATCHED, listeners=2)
            states.wait(False, "/hears", "/deaf")


def test_who_hears_nobody_takes_it_from_the_disk(ros_domain: int, peer: Peer, states: States) -> None:
    with node(ros_domain, "hears"), node(ros_domain, "alone", *ALONE) as alone:
        states.wait(False, "/hears")
        alone.wait_for_words("listens to")
        peer.say(STOP, Bool(data=True), qos=LATCHED, listeners=2)
        alone.wait_for_words("EMERGENCY STOP")
        peer.say(STOP, Bool(data=False), qos=LATCHED, listeners=2)
        alone.wait_for_words("is released")


@pytest.mark.parametrize("road", [DEAF, ALONE], ids=["state", "disk"])
def test_who_comes_between_stop_and_release_obeys_both(
    ros_domain: int, peer: Peer, states: States, road: tuple[str, ...]
) -> None:
    with node(ros_domain, "hears"):
        states.wait(False, "/hears")
        peer.say(STOP, Bool(data=True), qos=LATCHED, listeners=2)
        states.wait(True, "/hears")
        with node(ros_domain, "late", *road) as late:
            late.wait_for_words("EMERGENCY STOP")
            peer.say(STOP, Bool(data=False), qos=LATCHED, listeners=2)
            late.wait_for_words("is released")


def test_a_release_that_a_frozen_node_hears_late_frees_no_later_stop(
    ros_domain: int, peer: Peer, states: States
) -> None:
    both = ("/awake", "/frozen")
    with (
        node(ros_domain, "awake"),
        node(ros_domain, "frozen", module="drive_to_point") as frozen,
        Peer(ros_domain, "releasing") as releasing,
    ):
        states.wait(False, *both)
        peer.say(STOP, Bool(data=True), qos=LATCHED, listeners=4)
        states.wait(True, *both)
        # Of another publisher, whose word waits for who is frozen: it keeps more than the last.
        publisher = releasing.publisher(STOP, Bool)
        wait_until(lambda: publisher.get_subscription_count() >= 2, "who hears it")
        frozen.send(signal.SIGSTOP)
        publisher.publish(Bool(data=False))
        released_s = time.monotonic()
        states.wait(False, "/awake")
        peer.say(STOP, Bool(data=True), qos=LATCHED, listeners=4)
        states.wait(True, "/awake")
        too_late_s = released_s + LATE_NS / 1e9 + 0.2
        wait_until(lambda: time.monotonic() > too_late_s, "an age of no message under way")
        heard = peer.hear(STATE, DiagnosticArray)
        frozen.send(signal.SIGCONT)
        spoken = [*both, *both, *both]

        def after_the_thaw() -> list[tuple[str, str]]:
            statuses = [status for message in list(heard) for status in message.status]
            return [(one.name, dict_of(one)["engaged"]) for one in statuses]

        wait_until(
            lambda: not (Counter(spoken) - Counter(name for name, _ in after_the_thaw())), "three words of each"
        )
        assert {engaged for _, engaged in after_the_thaw()} == {"true"}


def test_a_stop_that_only_who_moves_nothing_has_heard_reaches_the_others_by_the_disk(
    ros_domain: int, peer: Peer, states: States
) -> None:
    with node(ros_domain, "deaf", *DEAF), node(ros_domain, "brain", module="ai_brain"):
        states.wait(False, "/deaf")
        peer.say(STOP, Bool(data=True))
        states.wait(True, "/deaf")


def test_who_restarts_while_it_is_released_is_free(
    ros_domain: int, peer: Peer, states: States, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even if its own disk still has the stop, as that of another computer."""
    with node(ros_domain, "hears"):
        monkeypatch.setenv("DECK_STATE_DIR", str(tmp_path / "another_computer"))
        with node(ros_domain, "deaf", *DEAF) as deaf:
            states.wait(False, "/hears", "/deaf")
            peer.say(STOP, Bool(data=True), qos=LATCHED, listeners=2)
            states.wait(True, "/hears", "/deaf")
            wait_until(lambda: stop_file(ros_domain).exists(), "the file")
            deaf.send(signal.SIGKILL)
        peer.say(STOP, Bool(data=False), qos=LATCHED, listeners=2)
        states.wait(False, "/hears")
        assert stop_file(ros_domain).exists()
        with node(ros_domain, "deaf", *DEAF) as deaf:
            deaf.wait_for_words("given before")
            states.wait(False, "/hears", "/deaf")
            wait_until(lambda: not stop_file(ros_domain).exists(), "the file gone")


def test_a_file_that_appears_is_a_stop_and_one_that_vanishes_no_release(ros_domain: int, states: States) -> None:
    with node(ros_domain, "one"), node(ros_domain, "two"):
        states.wait(False, "/one", "/two")
        place = stop_file(ros_domain)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text("?")
        states.wait(True, "/one", "/two")
        place.unlink()
        seen = states.when.copy()
        with Peer(ros_domain, "clerk") as clerk:
            told = clerk.hear(STATE, DiagnosticArray)
            wait_until(lambda: len(told) > 6, "three more seconds")
        assert states.when == seen


def test_an_old_latched_stop_that_was_released_does_not_stop_who_comes_later(
    ros_domain: int, peer: Peer, states: States
) -> None:
    with Peer(ros_domain, "forgetful") as forgetful, node(ros_domain, "first"):
        states.wait(False, "/first")
        forgetful.say(STOP, Bool(data=True), qos=LATCHED, listeners=2)
        states.wait(True, "/first")
        peer.say(STOP, Bool(data=False), qos=LATCHED, listeners=2)
        states.wait(False, "/first")
        with node(ros_domain, "second") as second:
            second.wait_for_words("listens to")
            states.wait(False, "/second")
            wait_until(lambda: forgetful.publisher(STOP, Bool).get_subscription_count() == 4, "its matches")
            told = peer.hear(STATE, DiagnosticArray)
            wait_until(lambda: len(told) > 4, "what they say then")
            assert states.engaged("/first", "/second") == {"false"}


def bare(domain: int, word: str) -> None:
    environment = {**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(domain)}
    subprocess.run([sys.executable, "-c", BARE, word], env=environment, check=True)


def pub_once(domain: int, word: str) -> None:
    environment = {**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(domain), "PYTHONPATH": str(ROOT)}
    words = ["topic", "pub", "--once", STOP, "std_msgs/msg/Bool", f"{{data: {word}}}"]
    subprocess.run(
        [sys.executable, "-m", "ros2", *words], env=environment, check=True, stdout=subprocess.DEVNULL, cwd=ROOT
    )


@pytest.mark.parametrize(("say", "most"), [(bare, 3), (pub_once, 1)])
@pytest.mark.timeout(240)
def test_a_publisher_that_lives_a_tenth_of_a_second_stops_and_releases_all(
    ros_domain: int, states: States, say: Callable[[int, str], None], most: int
) -> None:
    """All or none: of the other nodes' own publishers, a few in a thousand are heard by nobody."""
    names = [f"/node{number}" for number in range(4)]
    modules = ["electronic_differential", "safety_stop", "drive_to_point", "safety_stop"]
    processes = [
        node(ros_domain, name.strip("/"), module=module) for name, module in zip(names, modules, strict=True)
    ]
    try:
        states.wait(False, *names)
        for word in ["true", "false"] * 3:
            for _ in range(most):
                say(ros_domain, word)
                if comes(partial(states.agree, word, *names), 20.0):
                    break
                assert len(states.engaged(*names)) == 1
            assert states.agree(word, *names)
    finally:
        for process in processes:
            process.close()


def test_two_who_contradict_each_other_end_in_a_stop_that_names_them(ros_domain: int, states: States) -> None:
    with (
        node(ros_domain, "hears") as hears,
        node(ros_domain, "deaf", *DEAF),
        Peer(ros_domain, "stops") as stops,
        Peer(ros_domain, "releases") as releases,
    ):
        states.wait(False, "/hears", "/deaf")
        with releases.saying(STOP, Bool(data=False), 0.05), stops.saying(STOP, Bool(data=True), 0.1):
            hears.wait_for_words("while another keeps giving it")
            wait_until(lambda: states.of["/hears"].get("contradicted") == "true", "word of contradiction")
            wait_until(
                lambda: {"/stops", "/releases"} <= set(states.of["/hears"]["publishers"].split()), "their names"
            )
            states.wait(True, "/hears", "/deaf")
            seen = dict(states.when)
            told = stops.hear(STATE, DiagnosticArray)
            wait_until(lambda: len(told) > 12, "what they say for a while")
            assert states.when == seen
        with releases.saying(STOP, Bool(data=False), 0.05):
            states.wait(False, "/hears", "/deaf")
