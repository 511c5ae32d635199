"""The exchanges with nodes about lifecycle, log level and components, without any ROS."""

from __future__ import annotations

import contextlib
from typing import Any

import pytest

from graph.calls import components, logger_levels
from graph.calls.exchanges import Exchange, NodeRequest
from graph.calls.lifecycle import managed
from graph.calls.lifecycle_exchange import (
    CHANGE_WITHIN_S,
    ChangeFacts,
    LifecycleFacts,
    change,
    read,
    why_not,
)
from graph.data import ServiceRow, Value
from graph.inner_states import ComponentRow


def talk(exchange: Exchange, *answers: Any) -> list[NodeRequest]:
    """Give these answers in turn; return the requests."""
    asked = [next(exchange)]
    with contextlib.suppress(StopIteration):
        for answer in answers:
            asked.append(exchange.send(answer))  # noqa: PERF401 - it may end before
    return asked


def state(label: str) -> dict[str, Any]:
    return {"current_state": {"id": 0, "label": label}}


def possible(*transitions: tuple[int, str]) -> dict[str, Any]:
    return {
        "available_transitions": [
            {"transition": {"id": number, "label": label}} for number, label in transitions
        ]
    }


def test_transitions_that_a_node_makes_by_itself_are_not_offered() -> None:
    facts = LifecycleFacts()
    inner = possible((1, "configure"), (10, "transition_success"), (60, "transition_error"))
    talk(read(facts), state("configuring"), inner)
    assert (facts.state, facts.transitions) == ("configuring", {"configure": 1})


def test_what_is_not_possible_is_not_asked_for() -> None:
    facts = ChangeFacts()
    asked = talk(change("activate", facts), state("active"), possible((4, "deactivate")))
    assert [request.service for request in asked] == ["get_state", "get_available_transitions"]
    assert (facts.success, facts.after.state) == (None, "active")


def test_a_transition_is_asked_for_by_number_and_name_and_given_time() -> None:
    facts = ChangeFacts()
    configure = possible((1, "configure"))
    asked = talk(
        change("configure", facts),
        state("unconfigured"), configure, {"success": True}, state("inactive"), possible(),
    )  # fmt: skip
    wanted: dict[str, Value] = {"transition": {"id": 1, "label": "configure"}}
    assert asked[2] == NodeRequest("change_state", wanted, CHANGE_WITHIN_S)
    assert (facts.success, facts.after.state) == (True, "inactive")


@pytest.mark.parametrize(
    ("before", "after", "erred", "words"),
    [
        ("inactive", "inactive", False, "refuses to activate and stays inactive"),
        ("inactive", "unconfigured", False, "failed with an error in /a, which is now unconf"),
        ("unconfigured", "unconfigured", True, "failed with an error in /a, which is now unconf"),
        ("inactive", "finalized", True, "could not recover from: it is finalized"),
    ],
)
def test_a_failure_is_told_by_the_state_that_it_led_to(
    before: str, after: str, erred: bool, words: str
) -> None:
    facts = ChangeFacts(LifecycleFacts(before, {"activate": 3}), LifecycleFacts(after), False)
    assert words in why_not("/a", "activate", facts, erred=erred)


def test_only_a_node_that_serves_its_state_by_the_right_type_is_managed() -> None:
    kind = "lifecycle_msgs/srv/GetState"
    rows = (
        ServiceRow("/arm/a/get_state", (kind,), ("/arm/a",)),
        ServiceRow("/b/get_state", ("std_srvs/srv/Trigger",), ("/b",)),
        ServiceRow("/get_state", (kind,), ("/c",)),
        ServiceRow("/d/state", (kind,), ("/d",)),
    )
    assert managed(rows) == {"/arm/a"}


def test_the_level_in_effect_is_that_of_the_next_logger_above() -> None:
    found: list[str] = []
    told = [{"name": name, "level": number} for name, number in (("a.b", 0), ("a", 40), ("", 20))]
    (asked, *_) = talk(logger_levels.read("a.b", found), {"levels": told})
    assert asked.value == {"names": ["a.b", "a", ""]}
    assert found == ["error"]
    talk(logger_levels.read("a", found), {"levels": [{"name": "a", "level": 0}]})
    assert found == ["info"]
    talk(logger_levels.read("a", found), {"levels": [{"name": "a", "level": 25}]})
    assert found == ["25"]


@pytest.mark.parametrize(
    ("results", "why"),
    [
        ([{"successful": True, "reason": ""}], []),
        ([{"successful": False, "reason": "not today"}], ["not today"]),
        ([{"successful": False, "reason": ""}], ["the node refuses it and gives no reason"]),
        ([], ["the node refuses it and gives no reason"]),
    ],
)
def test_a_level_that_is_refused_is_told_beside_the_one_in_effect(
    results: list[dict[str, Any]], why: list[str]
) -> None:
    found: list[str] = []
    now = {"levels": [{"name": "a", "level": 30}]}
    asked = talk(logger_levels.write("a", 10, found), {"results": results}, now)
    assert asked[0].value == {"levels": [{"name": "a", "level": 10}]}
    assert found == ["warn", *why]


def test_a_logger_is_named_after_its_node() -> None:
    assert logger_levels.logger_of("/arm/gripper") == "arm.gripper"


def test_components_come_by_their_numbers_and_an_odd_answer_is_refused() -> None:
    found: list[ComponentRow] = []
    talk(components.read(found), {"unique_ids": [7, 3], "full_node_names": ["/b", "/a"]})
    assert found == [ComponentRow(3, "/a"), ComponentRow(7, "/b")]
    with pytest.raises(ValueError, match="shorter"):
        talk(components.read(found), {"unique_ids": [7, 3], "full_node_names": ["/b"]})
