"""A node, a profile and a log that mean harm, in the real program on a real terminal."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from std_msgs.msg import String

from tests.e2e.conftest import Deck
from tests.e2e.terminal import Terminal
from tests.hostile_text import EVIL, WORST, harm_on_screen, quoted
from tests.ros.peer import Peer

pytestmark = pytest.mark.nightly

PRINTING = f"""\
import sys, time
evil = {EVIL!r}.encode()
sys.stdout.buffer.write(evil + b"\\xff\\0\\n[ERROR] [1.0] [" + evil + b"]: said\\n")
sys.stdout.flush()
time.sleep(1000)
"""


def seen(terminal: Terminal) -> str:
    """All that the program has written to the terminal."""
    return bytes(terminal.kept).decode("utf-8", "surrogateescape")


def test_a_node_that_means_harm_reaches_no_terminal(deck: Deck, ros_domain: int) -> None:
    with Peer(ros_domain, "evil_node") as peer:
        words = ParameterDescriptor(description=EVIL, additional_constraints=EVIL)
        peer.node.declare_parameter("evil", EVIL, words)
        peer.node.add_on_set_parameters_callback(
            lambda _asked: SetParametersResult(successful=False, reason=EVIL)
        )
        word = peer.publisher("/evil_word", String)
        # Again and again: what is said before anybody listens is heard by nobody.
        timer = peer.node.create_timer(0.2, lambda: word.publish(String(data=EVIL)))
        complaint = peer.node.create_timer(0.5, lambda: peer.node.get_logger().error(EVIL))
        terminal = deck.open("watch", "--lang", "en")
        terminal.wait_for("evil_node")
        terminal.press("2", "/")
        terminal.type("evil\r")
        terminal.wait_for("␛]52;c;")
        terminal.press("y", "4")
        terminal.wait_gone("evil_word")
        terminal.wait_for("␛]52;c;")
        terminal.press("5")
        terminal.wait_for("E Parameters")
        terminal.press("E")
        terminal.wait_for("read in")
        terminal.press("enter")
        terminal.wait_for("Enter sets it")
        terminal.press("home")
        terminal.wait_for("\\u001b]52;c;")
        terminal.press("end", "left")
        terminal.type("x\r")
        terminal.wait_for("Refused:")
        terminal.press("escape")
        terminal.wait_gone("Refused:")
        terminal.press("q")
        assert terminal.wait_exit() == 0
        timer.cancel()
        complaint.cancel()
    assert not harm_on_screen(seen(terminal))


def test_a_profile_that_means_harm_reaches_no_terminal(deck: Deck, tmp_path: Path) -> None:
    script = tmp_path / "talks.py"
    script.write_text(PRINTING, encoding="utf-8")
    profile = tmp_path / "evil\x1b]52;c;ZXZpbA==\x07\u202e.yaml"
    profile.write_text(
        f"""\
title: {quoted(WORST)}
nodes:
  talks: {{exec: [{quoted(sys.executable)}, {quoted(str(script))}, {quoted(EVIL)}]}}
  missing: {{exec: [{quoted(EVIL)}], restart: never}}
""",
        encoding="utf-8",
    )
    terminal = deck.open(str(profile), "--lang", "en")
    terminal.wait_for("failed")
    terminal.wait_for("␛]52;c;")
    terminal.press("4")
    terminal.wait_for("said")
    terminal.press("6", "7", "5", "1", "q")
    assert terminal.wait_exit() == 0
    assert not harm_on_screen(seen(terminal))
