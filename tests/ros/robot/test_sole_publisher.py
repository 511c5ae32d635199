"""Whoever publishes what only the gate or the differential should is named by them."""

from __future__ import annotations

import signal
import time
from typing import TYPE_CHECKING

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState

from tests.deck_process import DeckProcess
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from typing import Any

pytestmark = pytest.mark.nightly

GATE: dict[str, object] = {"gate": True}
WORDS = "is also published by"


@pytest.mark.parametrize(
    ("module", "params", "topic", "kind"),
    [
        ("nodes.safety_stop", GATE, "/drive_safe", AckermannDriveStamped),
        ("nodes.electronic_differential", {}, "/wheel_commands", JointState),
    ],
)
def test_a_stranger_is_named_and_so_is_a_namesake(
    ros_domain: int, module: str, params: dict[str, object], topic: str, kind: Any
) -> None:
    began_s = time.monotonic()
    with NodeProcess(module, ros_domain, params=params) as node, Peer(ros_domain) as peer:
        own = "safety_node" if "safety" in module else "electronic_differential"
        wait_until(lambda: peer.node.count_publishers(topic), topic)
        with Peer(ros_domain, "evil") as evil:
            evil.publisher(topic, kind)
            node.wait_for_words("[WARN]", f"{topic} {WORDS} /evil")
            # What comes so late was not left by a node that died.
            wait_until(lambda: time.monotonic() - began_s > 6, "some seconds after the start")
            with NodeProcess(module, ros_domain, params=params) as second:
                # The second one, too, waits until a dead namesake would have been forgotten.
                second.wait_for_words(f"{topic} {WORDS} /evil")
                node.wait_for_words(f"{topic} {WORDS} /evil, another /{own}")


def test_the_own_publisher_of_before_a_kill_is_no_stranger(ros_domain: int) -> None:
    with Peer(ros_domain) as peer:
        heard = peer.hear("/wheel_commands", JointState)
        with NodeProcess("nodes.electronic_differential", ros_domain) as dead:
            wait_until(lambda: heard, "wheel commands")
            dead.send(signal.SIGKILL)
            dead.wait()
        with NodeProcess("nodes.electronic_differential", ros_domain) as node:
            wait_until(lambda: peer.node.count_publishers("/wheel_commands"), "the new one")
            heard.clear()
            wait_until(lambda: len(heard) > 10, "five seconds of it")
            assert WORDS not in node.output


def test_deck_run_says_it_as_a_warning(ros_domain: int) -> None:
    with Peer(ros_domain, "evil") as evil:
        evil.publisher("/wheel_commands", JointState)
        run = DeckProcess("run", "04b-electronic-differential", "--for", "60")
        try:
            line = run.said("/wheel_commands is also published by /evil")
            assert "electronic_differential" in line
            assert "WARN" in line.upper()
        finally:
            run.signal(signal.SIGINT)
            run.finish()
