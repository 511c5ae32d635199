"""A person at a terminal: starts a lesson, looks, stops the robot, leaves; nothing stays behind."""

from __future__ import annotations

import os
import signal

from tests.e2e import marked
from tests.e2e.conftest import Deck
from tests.e2e.listening import wait_for_the_gate
from tests.waiting import wait_until

SCREENS = {
    "f3": "std_msgs/Float32",
    "f4": '"commands"',
    "f5": "safety_stop",
    "f2": "Sonar",
    "f1": "Keys of this screen",
}
"""Function key to what stands on the screen that it opens."""


def test_enter_starts_a_lesson_space_holds_it_and_q_leaves_nothing_running(deck: Deck) -> None:
    terminal = deck.open("--lang", "en")
    terminal.wait_for("Starts 1 node")
    terminal.press("end", "up", "up")
    terminal.wait_for("Starts 9 nodes")
    terminal.press("enter")
    terminal.wait_for("9/9")
    assert len(marked.nodes(deck.mark)) == 9
    wait_for_the_gate(terminal)
    terminal.press("f2", "space")
    terminal.wait_for("EMERGENCY STOP: nothing moves")
    terminal.wait_until(lambda text: "EMERGENCY STOP" in title(text), "the stop in the title")
    terminal.press("ctrl+r")
    terminal.wait_until(lambda text: "9/9" in title(text), "all at work again")
    terminal.press("q")
    assert terminal.wait_exit() == 0
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


def test_a_stop_that_outlives_its_screen_is_released_from_the_next(deck: Deck) -> None:
    assert deck.open("up", "02-sonar-safety", "--lang", "en").wait_exit() == 0
    first = deck.open("attach", "--lang", "en")
    first.wait_for("2/2")
    wait_for_the_gate(first)
    first.press("ctrl+x", "f2")
    first.wait_for("EMERGENCY STOP: nothing moves")
    first.press("q")
    assert first.wait_exit() == 0
    second = deck.open("attach", "--lang", "en")
    second.wait_for("EMERGENCY STOP (from earlier) since ")
    # What was said before it came.
    second.wait_for("EMERGENCY STOP: nothing moves")
    second.press("ctrl+r")
    second.wait_for("The emergency stop is released")
    second.wait_until(lambda text: "EMERGENCY" not in title(text), "the title without the stop")
    second.press("q")
    assert second.wait_exit() == 0
    assert deck.open("down").wait_exit() == 0


def title(screen: str) -> str:
    return "\n".join(screen.splitlines()[:2])


def supervisors(mark: str) -> list[int]:
    return [pid for pid, line in marked.alive(mark).items() if "launcher.supervisor" in line]


def test_what_the_picker_makes_ready_goes_with_it(deck: Deck) -> None:
    terminal = deck.open("--lang", "en")
    wait_until(lambda: supervisors(deck.mark), "a supervisor ahead of any choice")
    terminal.press("ctrl+q")
    assert terminal.wait_exit() == 0
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


def test_a_lesson_starts_though_what_was_made_ready_has_died(deck: Deck) -> None:
    terminal = deck.open("--lang", "en")
    (ahead,) = wait_until(lambda: supervisors(deck.mark), "a supervisor ahead of any choice")
    os.kill(ahead, signal.SIGKILL)
    wait_until(lambda: not supervisors(deck.mark), "the supervisor gone")
    terminal.wait_for("One screen instead of five terminals")
    terminal.press("home", "down", "enter")
    terminal.wait_for("1/1")


def test_every_screen_answers_to_its_key_and_none_breaks_when_resized(deck: Deck) -> None:
    terminal = deck.open("02-sonar-safety", "--lang", "en")
    terminal.wait_for("2/2")
    for key, shown in SCREENS.items():
        terminal.press(key)
        terminal.wait_for(shown)
        for columns, rows in ((200, 60), (40, 10), (120, 40)):
            terminal.resize(columns, rows)
        terminal.wait_for(shown)
    assert terminal.process.poll() is None


def test_a_terminated_screen_gives_the_terminal_back(deck: Deck) -> None:
    terminal = deck.open("01-hello", "--lang", "en")
    terminal.wait_for("1/1")
    terminal.process.send_signal(signal.SIGTERM)
    terminal.wait_exit()
    terminal.wait_gone("1/1")
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


def test_a_killed_supervisor_is_said_and_leaves_no_node(deck: Deck) -> None:
    terminal = deck.open("02-sonar-safety", "--lang", "en")
    terminal.wait_for("2/2")
    (supervisor,) = supervisors(deck.mark)
    os.kill(supervisor, signal.SIGKILL)
    wait_until(lambda: not marked.nodes(deck.mark), "every node gone")
    assert terminal.process.poll() is None
    terminal.wait_until(lambda text: "supervisor" in text, "a word about the supervisor")
