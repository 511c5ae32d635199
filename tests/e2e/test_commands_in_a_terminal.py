"""The commands at a terminal: keys that stop, a window that closes, a screen come and gone."""

from __future__ import annotations

from pathlib import Path

from tests.e2e import marked
from tests.e2e.conftest import Deck
from tests.unit.profile_files import written
from tests.waiting import wait_until


def test_ctrl_c_ends_a_run_with_its_summary(deck: Deck) -> None:
    terminal = deck.open("run", "02-sonar-safety")
    terminal.wait_for("[safety_stop] ready")
    terminal.wait_for("[sonar_front] ready")
    terminal.press("ctrl+c")
    assert terminal.wait_exit() == 0
    terminal.wait_for("every node stayed healthy")
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


def test_a_window_that_closes_ends_a_run(deck: Deck, tmp_path: Path) -> None:
    path = written(tmp_path, "nodes: {a: {exec: [sh, -c, 'while :; do echo up; sleep 0.1; done']}}")
    terminal = deck.open("run", str(path))
    terminal.wait_for("[a]    up")
    terminal.hang_up()
    terminal.wait_exit()
    wait_until(lambda: not marked.alive(deck.mark), "nothing is left")


def test_a_bad_profile_is_told_in_place_of_the_screen(deck: Deck, tmp_path: Path) -> None:
    terminal = deck.open(str(written(tmp_path, "nodes: {a: {run: nodes.helo}}")))
    assert terminal.wait_exit() == 2
    text = terminal.wait_for_line("did you mean nodes.hello?")
    assert "lesson.yaml:1:18: nodes.a.run: there is no module 'nodes.helo'" in text


def test_the_screen_comes_and_goes_while_the_nodes_run_on(deck: Deck) -> None:
    up = deck.open("up", "01-hello")
    up.wait_for("`deck attach` shows it")
    assert up.wait_exit() == 0
    (hello,) = marked.nodes(deck.mark)
    screen = deck.open("attach")
    screen.wait_for("1/1")
    screen.press("q")
    assert screen.wait_exit() == 0
    assert list(marked.nodes(deck.mark)) == [hello]
    down = deck.open("down")
    down.wait_for("01-hello stopped, 1 node")
    assert down.wait_exit() == 0
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


def test_attach_with_nothing_to_attach_to_says_so(deck: Deck) -> None:
    terminal = deck.open("attach")
    terminal.wait_for("nothing runs in the background")
    assert terminal.wait_exit() == 1


def test_attach_to_what_does_not_run_says_so_without_a_screen(deck: Deck) -> None:
    terminal = deck.open("attach", "02")
    terminal.wait_for("'02' is not running, nor is anything else")
    assert terminal.wait_exit() == 1
    assert terminal.received < 200, "a screen takes thousands of bytes"
