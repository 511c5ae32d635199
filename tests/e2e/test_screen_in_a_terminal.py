"""A person at a terminal: starts a lesson, looks, stops the robot, leaves; nothing stays behind."""

from __future__ import annotations

import os
import signal

from tests.e2e import marked
from tests.e2e.conftest import Deck
from tests.waiting import wait_until

BRAIN = ("09-brain", "--lang", "en")

SCREENS = {
    "f3": "std_msgs/Float32",
    "f4": '"commands"',
    "f5": "safety_stop",
    "f2": "Sonar",
    "f1": "Keys of this screen",
}
"""Function key to what stands on the screen that it opens."""


def test_enter_starts_lesson_nine_and_q_leaves_nothing_running(deck: Deck) -> None:
    terminal = deck.open("--lang", "en")
    terminal.wait_for("One screen instead of five terminals")
    terminal.press("enter")
    terminal.wait_for("8/8")
    assert len(marked.nodes(deck.mark)) == 8
    terminal.press("q")
    assert terminal.wait_exit() == 0
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


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
    terminal.press("enter")
    terminal.wait_for("8/8")


def test_every_screen_answers_to_its_key_and_none_breaks_when_resized(deck: Deck) -> None:
    terminal = deck.open("02-sonar-safety", "--lang", "en")
    terminal.wait_for("2/2")
    for key, shown in SCREENS.items():
        terminal.press(key)
        terminal.wait_for(shown)
        for columns, rows in ((200, 60), (80, 24), (40, 10), (120, 40)):
            terminal.resize(columns, rows)
        terminal.wait_for(shown)
    assert terminal.process.poll() is None


def test_the_space_bar_holds_the_wheels_until_the_stop_is_released(deck: Deck) -> None:
    terminal = deck.open(*BRAIN)
    terminal.wait_for("8/8")
    terminal.press("space")
    terminal.wait_for("EMERGENCY STOP")
    terminal.wait_until(lambda text: "emergency stop" in text.lower(), "the gate's own word")
    terminal.press("ctrl+r")
    terminal.wait_gone("EMERGENCY STOP")


def test_a_closed_window_stops_the_robot(deck: Deck) -> None:
    terminal = deck.open("02-sonar-safety")
    terminal.wait_for("2/2")
    terminal.hang_up()
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


def test_a_killed_screen_leaves_no_node(deck: Deck) -> None:
    terminal = deck.open(*BRAIN)
    terminal.wait_for("8/8")
    os.kill(terminal.process.pid, signal.SIGKILL)
    terminal.wait_exit()
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


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
