"""A learner's own node, started by hand in the lesson's domain, stands in Deck and in its log."""

from __future__ import annotations

import pytest

from tests.e2e.conftest import Deck
from tests.ros.peer import Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly


def test_a_node_started_by_hand_is_listed_and_heard(deck: Deck, ros_domain: int) -> None:
    terminal = deck.open("01-hello", "--lang", "en", columns=80, rows=24)
    terminal.wait_for("1/1")
    with Peer(ros_domain, "my_node") as mine:
        # What was said before Deck has seen it is heard, too.
        mine.node.get_logger().warning("I am awake")
        screen = terminal.wait_for("◇ outside")
        assert "1/1" in screen
        terminal.wait_for("I am awake")
        terminal.press("end")
        terminal.wait_for("▶ my_node")
        terminal.press("x")
        terminal.wait_for("was not started by Deck")
        terminal.press("4")
        mine.node.get_logger().warning("still here")
        terminal.wait_for("still here")
        lines = [line for line in terminal.text().splitlines() if "I am awake" in line]
        assert len(lines) == 1
        terminal.press("1")
        terminal.wait_for("◇ outside")
    wait_until(lambda: "◇ outside" not in terminal.text(), "a list without it")
    terminal.press("q")
    assert terminal.wait_exit() == 0
