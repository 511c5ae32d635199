"""`deck watch` on a node that somebody else has started; it is left as it was."""

from __future__ import annotations

import subprocess
import sys

from tests.e2e.conftest import ROOT, Deck
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until


def test_a_running_node_is_seen_stopped_by_nobody_and_left_alone(deck: Deck, ros_domain: int) -> None:
    params: dict[str, object] = {"pattern": "constant", "value": 1.25, "rate": 5.0}
    with NodeProcess("nodes.mock_sonar", ros_domain, name="ours", params=params) as node:
        terminal = deck.open("watch", "--domain", str(ros_domain), "--lang", "en")
        screen = terminal.wait_for("1 node runs here: ours")
        assert "Deck has started nothing here" in screen
        terminal.wait_for("watching domain")
        terminal.wait_for("Distance 1.25 m")
        terminal.press("2")
        terminal.wait_for("filter: words of a name")
        terminal.wait_for("std_msgs/Float32")
        terminal.press("4")
        terminal.wait_gone("std_msgs/Float32")
        terminal.wait_for("Distance 1.25 m")
        terminal.press("q")
        assert terminal.wait_exit() == 0
        assert node.process.poll() is None


def test_the_emergency_stop_reaches_who_listens(deck: Deck, ros_domain: int) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain) as node, Peer(ros_domain) as peer:
        terminal = deck.open("watch", "--lang", "en")
        terminal.wait_for("electronic_differential")
        wait_until(lambda: peer.node.count_subscribers("/emergency_stop"), "its subscription")
        terminal.press("space")
        terminal.wait_for("■ EMERGENCY STOP")
        node.wait_for_words("EMERGENCY STOP: the wheels stand")
        terminal.press("ctrl+r")
        node.wait_for_words("released; waiting")
        terminal.press("q")
        assert terminal.wait_exit() == 0


def test_a_domain_that_is_none_and_a_terminal_that_is_none_are_told(ros_domain: int) -> None:
    del ros_domain
    for arguments, words in (
        (("--domain", "999"), "999"),
        (("--discovery", "moon"), "moon"),
        ((), "watch needs a terminal"),
    ):
        run = subprocess.run(
            [sys.executable, "-m", "tui", "watch", *arguments, "--lang", "en"],
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )
        assert run.returncode == 2
        assert words in run.stderr
        assert "Traceback" not in run.stderr
