"""Somebody who publishes past the differential stands in red on the smallest terminal."""

from __future__ import annotations

import pytest
from sensor_msgs.msg import JointState

from tests.e2e.conftest import Deck
from tests.ros.peer import Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

RED = "b00020"
WORDS = "Foreign commands on /wheel_commands: /evil"


def test_a_bypass_is_named_for_as_long_as_it_is_there(deck: Deck, ros_domain: int) -> None:
    terminal = deck.open("04b-electronic-differential", "--lang", "en", columns=80, rows=24)
    terminal.wait_for("2/2")
    assert "Foreign" not in terminal.text()
    with Peer(ros_domain, "evil") as evil:
        evil.publisher("/wheel_commands", JointState)
        wait_until(lambda: WORDS in terminal.text().splitlines()[1], "the title of the lesson")
        column = terminal.text().splitlines()[1].index(WORDS)
        wait_until(lambda: terminal.ground(column, 1) == RED, "red")
        # The toast beside it goes by itself.
        terminal.press("4")
        wait_until(lambda: WORDS in terminal.text().splitlines()[1], "the title of the logs")
        terminal.wait_for("is also published by ")
    wait_until(lambda: WORDS not in terminal.text().splitlines()[1], "a title without it")
    terminal.press("q")
    assert terminal.wait_exit() == 0
