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
    asked = third.wait_for("End what was started elsewhere?")
    assert f"(pid {owner.process.pid})" in asked
    assert "On another screen" in asked
    third.press("enter")
    owner.wait_for("ended from elsewhere")
    owner.wait_for(f"(pid {third.process.pid})")
    third.wait_for("The lessons")
    third.press("q")
    assert third.wait_exit() == 0
    owner.press("q")
    assert owner.wait_exit() == 0


def test_down_is_told_to_the_screen_whose_session_it_ends(deck: Deck) -> None:
    owner = deck.open("01", "--lang", "en")
    owner.wait_for("1/1")
    down = deck.open("down")
    assert down.wait_exit() == 0
    owner.wait_for("ended from elsewhere")
    owner.wait_for(f"(pid {down.process.pid})")
    owner.press("q")
    assert owner.wait_exit() == 0
