"""Two screens on one session: leaving is not ending, and who ends it is named on the other."""

from __future__ import annotations

from tests.e2e.conftest import Deck


def test_leaving_anothers_session_leaves_it_alone_and_ending_it_says_who(deck: Deck) -> None:
    owner = deck.open("01", "--lang", "en")
    owner.wait_for("1/1")
    other = deck.open("attach", "--lang", "en")
    other.wait_for("1/1")
    other.wait_for("q Detach")
    other.press("q")
    assert other.wait_exit() == 0
    assert "left as it is: 01-hello in domain" in other.text()
    third = deck.open("attach", "--lang", "en")
    third.wait_for("q Detach")
    assert "1/1" in owner.text()
    third.type("\x1b[19;2~")
    third.wait_for("End what was started elsewhere?")
    third.wait_for("On another screen: ")
    third.wait_for(f"(pid {owner.process.pid})")
    third.press("enter")
    owner.wait_for("ended from elsewhere")
    owner.wait_for(f"(pid {third.process.pid})")
    third.wait_for("The lessons")
    third.press("q")
    assert third.wait_exit() == 0
    owner.press("q")
    assert owner.wait_exit() == 0


def test_a_second_lesson_in_the_domain_is_asked_about_before_it_starts(deck: Deck) -> None:
    first = deck.open("01", "--lang", "en")
    first.wait_for("1/1")
    second = deck.open("08", "--lang", "en")
    second.wait_for("Running there already:")
    second.wait_for("01-hello: ")
    second.press("s")
    second.wait_for("08-audio")
    second.wait_for("1/1")
    again = deck.open("01", "--lang", "en")
    again.wait_for("one domain is not enough")
    assert "Start beside it" not in again.wait_for("esc Do not start")
    again.press("escape")
    assert again.wait_exit() == 2
    assert "is free" in again.text()
    for terminal in (first, second):
        terminal.press("q")
        assert terminal.wait_exit() == 0


def test_down_is_told_to_the_screen_whose_session_it_ends(deck: Deck) -> None:
    owner = deck.open("01", "--lang", "en")
    owner.wait_for("1/1")
    down = deck.open("down")
    assert down.wait_exit() == 0
    owner.wait_for("ended from elsewhere")
    owner.wait_for(f"(pid {down.process.pid})")
    owner.press("q")
    assert owner.wait_exit() == 0
