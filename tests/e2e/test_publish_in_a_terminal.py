"""A person publishes from the screen of topics, and real nodes hear it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.e2e.conftest import Deck

DELETE, F12 = "\x1b[3~", "\x1b[24~"


def test_a_message_is_filled_in_published_and_repeated_until_it_is_stopped(deck: Deck) -> None:
    terminal = deck.open("04-ackermann", "--lang", "en")
    terminal.wait_for("1/1")
    terminal.press("f3")
    terminal.wait_for("filter: words")
    terminal.wait_for("/ai_command")
    # Without a pause, as somebody types who knows the way.
    terminal.type("/ai_command")
    terminal.wait_for("1 of ")
    terminal.press("enter", "P")
    terminal.wait_for("valid std_msgs/msg/String")
    # A word where a text belongs that YAML takes for a truth: named, and not sent.
    terminal.type("data: on #")
    terminal.wait_for("line 1: data: expected a string, got True: put it in quotes")
    terminal.press("ctrl+s")
    terminal.wait_for("Not sent")
    # The cursor stands on the word by now.
    terminal.type(DELETE * len("on") + '"стоп"')
    terminal.wait_for("valid std_msgs/msg/String")
    terminal.press("ctrl+s")
    terminal.wait_for("got it.")
    terminal.press("ctrl+g")
    terminal.wait_for("Publishing to /ai_command at 10 Hz.")
    terminal.wait_for("Subscribers")
    terminal.type(F12)
    terminal.wait_for("Stopped: /ai_command")
    terminal.wait_gone("Subscribers")
