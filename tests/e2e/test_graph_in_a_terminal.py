"""A person looks into the graph: calls the head's service, reads parameters, walks."""

from __future__ import annotations

import os
import signal

from tests.e2e import marked
from tests.e2e.conftest import Deck
from tests.e2e.terminal import Terminal


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
    terminal.wait_for("fits example_interfaces/srv/AddTwoInts")
    terminal.press("enter", "ctrl+s")
    terminal.wait_for("Answer in")
    wait_for_words(terminal, "sum: 1")


def test_a_parameter_is_read_and_set_and_a_refusal_is_told(deck: Deck) -> None:
    terminal = at_the_graph(deck, "02-sonar-safety", 2)
    terminal.press("/")
    terminal.type("sonar")
    terminal.wait_for("1 of ")
    terminal.press("enter")
    terminal.wait_for("p Parameters")
    terminal.press("p")
    terminal.wait_for("read in")
    terminal.press("home", "enter")
    terminal.wait_for("Enter sets it")
    terminal.type("nonsense")
    terminal.press("enter")
    terminal.wait_for("Refused:")


def test_the_map_shows_who_talks_to_the_brain(deck: Deck) -> None:
    terminal = at_the_graph(deck, "09-brain", 8)
    # Which node is found first, and chosen, is not for sure.
    terminal.press("/")
    terminal.type("brain")
    terminal.wait_for("1 of ")
    terminal.press("enter")
    terminal.wait_for("p Parameters")
    terminal.press("m")
    terminal.wait_for("┌─")
    terminal.wait_for("/set_head_position()")
    terminal.wait_for("head_controller")


def test_a_node_that_hangs_freezes_nothing_and_is_told(deck: Deck) -> None:
    terminal = at_the_graph(deck, "02-sonar-safety", 2)
    (hung,) = (pid for pid, line in marked.nodes(deck.mark).items() if "safety" in line)
    os.kill(hung, signal.SIGSTOP)
    try:
        terminal.press("/")
        terminal.type("safety")
        terminal.wait_for("1 of ")
        terminal.press("enter")
        terminal.wait_for("p Parameters")
        terminal.press("p")
        terminal.wait_for("no answer for")
        terminal.press("1")
        terminal.wait_for("Sonar", within_s=3.0)
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
    terminal.wait_for("fits deck_interfaces/action/DriveToPoint")
    terminal.press("ctrl+s")
    terminal.wait_for("#1")
    terminal.wait_until(lambda text: "✓ succeeded" in text or "✗" in text, "the goal's end")
