"""A proposal is carried out once, soon, by its agent; ways without a question add up."""

from __future__ import annotations

import pytest

from agents.motion import Motion
from agents.proposals import EXECUTED_WITHIN_S, MAX_OPEN, ProposalBook
from agents.refusal import RefusedError
from agents.unasked_way import UnaskedWay
from launcher.consent import ALLOWED_FOR_S


class Time:
    """A clock that is set."""

    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


def test_it_is_taken_once() -> None:
    book = ProposalBook()
    made = book.add("a", "run", Motion(), "")
    assert book.take(made.id, "a", "run") is made
    with pytest.raises(RefusedError, match="carried out once"):
        book.take(made.id, "a", "run")
    assert book.add("a", "run", Motion(), "").id != made.id


def test_it_is_of_one_agent_and_one_session() -> None:
    book = ProposalBook()
    made = book.add("a", "run", Motion(), "")
    with pytest.raises(RefusedError):
        book.take(made.id, "b", "run")
    with pytest.raises(RefusedError, match="another session"):
        book.take(made.id, "a", "run 2")


def test_it_expires() -> None:
    now = Time()
    book = ProposalBook(now)
    made = book.add("a", "run", Motion(), "")
    now.now_s = EXECUTED_WITHIN_S + 0.1
    with pytest.raises(RefusedError, match="older than 60 s"):
        book.take(made.id, "a", "run")


def test_a_stop_ends_them_and_old_ones_make_way() -> None:
    book = ProposalBook()
    made = [book.add("a", "run", Motion(), "") for _ in range(MAX_OPEN + 1)]
    with pytest.raises(RefusedError):
        book.take(made[0].id, "a", "run")
    book.clear()
    with pytest.raises(RefusedError):
        book.take(made[-1].id, "a", "run")


def test_ways_without_a_question_add_up_for_as_long_as_an_allowance() -> None:
    now = Time()
    way = UnaskedWay(now)
    way.add(0.6)
    now.now_s = 100.0
    way.add(0.3)
    assert way.has_room(0.1, 1.0)
    assert not way.has_room(0.11, 1.0)
    now.now_s = ALLOWED_FOR_S + 1
    assert way.left_m(1.0) == pytest.approx(0.7)
