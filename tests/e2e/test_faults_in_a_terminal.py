"""Numbers that nobody expects, and a panel that fails: the screen, the nodes and the stop live."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from sensor_msgs.msg import JointState

from tests.e2e import marked
from tests.e2e.conftest import ROOT
from tests.e2e.terminal import Terminal
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from tests.e2e.conftest import Deck

LESSON = "04b-electronic-differential"
NAMES = ["rear_left_wheel_joint", "rear_right_wheel_joint", "steering_joint"]
BROKEN = """
import sys
from tui.panels.wheels import WheelsView

def fail(self, width, height):
    raise OverflowError("broken on purpose")

WheelsView.draw = fail
from cli import main
sys.exit(main())
"""
"""The program itself, with one drawing that cannot be drawn."""


def test_one_huge_number_ends_neither_the_screen_nor_the_nodes(deck: Deck, ros_domain: int) -> None:
    terminal = deck.open(LESSON)
    terminal.wait_for("2/2")
    huge = JointState(name=NAMES, position=[0.0, 0.0, 1e308], velocity=[1e308, -1e308, 0.0])
    with Peer(ros_domain) as peer, peer.saying("/wheel_commands", huge, 0.02):
        terminal.wait_for("out of range: 1e308 rad")
        assert_the_robot_stops(deck, terminal, peer)
    leave(deck, terminal)


def test_a_panel_that_fails_says_so_in_its_place_and_in_the_log(deck: Deck, ros_domain: int, tmp_path: Path) -> None:
    argv = [sys.executable, "-c", BROKEN, LESSON]
    terminal = Terminal(argv, 120, 40, {**deck.env, "DECK_LOG_DIR": str(tmp_path)}, cwd=str(ROOT))
    deck.terminals.append(terminal)
    terminal.wait_for("2/2")
    with Peer(ros_domain) as peer:
        # Wrapped by the panel, in one piece on the line of the log.
        terminal.wait_for("Wheels has failed (OverflowError: broken on purpose)")
        assert_the_robot_stops(deck, terminal, peer)
    (journal,) = tmp_path.glob("screen-*.log")
    traces = journal.read_text(encoding="utf-8").count("Traceback (most recent call last)")
    assert traces == 1
    leave(deck, terminal)


def assert_the_robot_stops(deck: Deck, terminal: Terminal, peer: Peer) -> None:
    """The space bar stops the wheels, all nodes are there, and another screen opens."""
    assert len(marked.nodes(deck.mark)) == 2
    wait_until(lambda: peer.node.count_subscribers("/emergency_stop"), "who obeys the stop")
    terminal.press("space")
    terminal.wait_for("EMERGENCY STOP")
    assert len(marked.nodes(deck.mark)) == 2
    terminal.press("f3")
    terminal.wait_for("std_msgs/String")
    terminal.press("f2")
    terminal.wait_for("● ready")


def leave(deck: Deck, terminal: Terminal) -> None:
    terminal.press("q")
    assert terminal.wait_exit() == 0
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")
