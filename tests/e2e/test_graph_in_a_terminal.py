"""A person looks into the graph: calls the head's service, reads parameters, walks."""

from __future__ import annotations

import os
import signal

import pytest

from tests.e2e import marked
from tests.e2e.conftest import Deck
from tests.e2e.terminal import Terminal

pytestmark = pytest.mark.nightly


def at_the_graph(deck: Deck, profile: str, nodes: int) -> Terminal:
    terminal = deck.open(profile, "--lang", "en")
    terminal.wait_for(f"{nodes}/{nodes}")
    terminal.press("5")
    terminal.wait_for(f"Nodes {nodes}")
    return terminal


def wait_for_words(terminal: Terminal, words: str) -> None:
    """Wait until these words are on the screen, with as many blanks as may be."""
    terminal.wait_until(lambda text: words in " ".join(text.split()), repr(words))


def test_the_head_is_turned_by_a_call_from_the_graph(deck: Deck) -> None:
    terminal = at_the_graph(deck, "03-head-service", 1)
    terminal.press("right")
    terminal.wait_for("valid example_interfaces/srv/AddTwoInts")
    terminal.press("enter", "ctrl+s")
    terminal.wait_for("Response in")
    wait_for_words(terminal, "sum: 1")


def at_the_node(terminal: Terminal, name: str) -> None:
    """Choose the node with this in its name, whichever was found first."""
    terminal.press("/")
    terminal.type(name)
    terminal.wait_for("1 of ")
    terminal.press("enter")
    terminal.wait_for("E Parameters")


def test_a_map_is_drawn_a_parameter_refused_and_a_node_that_hangs_is_told(deck: Deck) -> None:
    terminal = at_the_graph(deck, "02-sonar-safety", 2)
    at_the_node(terminal, "sonar")
    terminal.press("M")
    terminal.wait_for("┌─")
    terminal.wait_for("│ /sonar_front │─┘    safety_stop")
    terminal.press("M", "E")
    terminal.wait_for("read in")
    terminal.press("home", "enter")
    terminal.wait_for("Enter sets it")
    terminal.type("nonsense\r")
    terminal.wait_for("Refused:")
    terminal.press("escape")
    # Escape and a sign that follow each other at once are another key.
    terminal.wait_gone("Refused:")
    (hung,) = (pid for pid, line in marked.nodes(deck.mark).items() if "safety" in line)
    os.kill(hung, signal.SIGSTOP)
    try:
        terminal.press("/", "escape")
        terminal.wait_gone("1 of ")
        at_the_node(terminal, "safety")
        terminal.wait_for("no answer for")
        terminal.press("1")
        # The question waits for 5 s: meanwhile keys are obeyed.
        terminal.wait_for("Sonar", within_s=4.0)
        terminal.press("5")
        terminal.wait_for("could not be read")
    finally:
        os.kill(hung, signal.SIGCONT)


def test_a_goal_is_sent_and_reached_with_feedback_on_the_way(deck: Deck) -> None:
    terminal = deck.open("03b-drive-to-point", "--lang", "en")
    terminal.wait_for("● ")
    terminal.press("5")
    terminal.wait_for("Actions 1")
    terminal.press("right", "right")
    terminal.wait_for("valid deck_interfaces/action/DriveToPoint")
    terminal.press("ctrl+s")
    terminal.wait_for("#1")
    terminal.wait_until(lambda text: "✓ succeeded" in text or "✗" in text, "the goal's end")
