"""Who publishes a topic that a replay has left, said once it is known."""

from __future__ import annotations

from graph.bag.publishing import NAMED_WITHIN_S, left_to
from graph.data import NAMELESS
from text.sentences import say


def test_a_node_is_named() -> None:
    assert left_to(["/late"], 0.0) == say("{node} publishes it", node="/late")


def test_a_name_that_is_not_known_yet_is_waited_for() -> None:
    assert left_to([f"/{NAMELESS}"], 0.1) is None
    assert left_to([f"/{NAMELESS}", "/late"], 0.1) == say("{node} publishes it", node="/late")


def test_a_program_without_a_node_is_said_in_the_end() -> None:
    without = say("another program publishes it")
    assert left_to([f"/{NAMELESS}"], NAMED_WITHIN_S + 0.1) == without
    assert left_to([], NAMED_WITHIN_S + 0.1) == without
