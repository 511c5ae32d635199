"""Who cannot hear whom, and what Deck asks for so that it hears everybody."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from graph.data import EndpointInfo, Trouble
from graph.housekeeping import is_housekeeping
from graph.messages.types import UnknownTypeError
from graph.observer.troubles import quiet, structural
from graph.qos import Qos, to_be_heard, to_hear
from graph.qos_compatibility import mismatches
from graph.scan.endpoints import TopicEnds, full_name

FLOAT = "std_msgs/msg/Float32"


def end(node: str, reliability: str = "reliable", durability: str = "volatile") -> EndpointInfo:
    return EndpointInfo(node, FLOAT, reliability, durability)


BEST_EFFORT = end("/camera", "best_effort")
LATCHED = end("/map", "reliable", "transient_local")
PLAIN = end("/plain")


@pytest.mark.parametrize(
    ("publishers", "wanted"),
    [
        ([], Qos("reliable", "volatile")),
        ([PLAIN], Qos("reliable", "volatile")),
        ([BEST_EFFORT], Qos("best_effort", "volatile")),
        ([LATCHED], Qos("reliable", "transient_local")),
        ([LATCHED, PLAIN], Qos("reliable", "volatile")),
        ([LATCHED, BEST_EFFORT], Qos("best_effort", "volatile")),
    ],
)
def test_the_request_is_the_strongest_that_all_publishers_meet(
    publishers: list[EndpointInfo], wanted: Qos
) -> None:
    assert to_hear(publishers) == wanted
    ours = EndpointInfo("/deck", FLOAT, wanted.reliability, wanted.durability)
    assert mismatches(publishers, [ours]) == []


@pytest.mark.parametrize("subscribers", [[], [PLAIN], [BEST_EFFORT], [LATCHED], [LATCHED, PLAIN]])
def test_the_offer_meets_all_subscribers(subscribers: list[EndpointInfo]) -> None:
    offer = to_be_heard(subscribers)
    ours = EndpointInfo("/deck", FLOAT, offer.reliability, offer.durability)
    assert mismatches([ours], subscribers) == []


def test_a_mismatch_names_both_sides_and_the_ways_out() -> None:
    (found,) = mismatches([BEST_EFFORT, PLAIN], [end("/vlm")])
    assert found.what == (
        "/vlm does not hear /camera: reliability reliable is asked for, best_effort is offered."
    )
    assert found.mend == "Let /camera offer reliable, or let /vlm ask for best_effort."
    (found,) = mismatches([PLAIN], [LATCHED])
    assert found.facts() == {
        "policy": "durability",
        "publisher": "/plain",
        "subscriber": "/map",
        "offered": "volatile",
        "requested": "transient_local",
    }


def told(offer: dict[str, Any], request: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Policy, offer and request of each mismatch of one publisher and one subscriber."""
    found = mismatches([replace(end("/p"), **offer)], [replace(end("/s"), **request)])
    return [(one.policy, one.offered, one.requested) for one in found]


def test_a_deadline_is_met_by_one_that_is_as_short() -> None:
    assert told({"deadline_s": 0.5}, {"deadline_s": 0.5}) == []
    assert told({"deadline_s": 0.1}, {"deadline_s": 0.5}) == []
    assert told({"deadline_s": 0.1}, {}) == []
    assert told({"deadline_s": 0.5}, {"deadline_s": 0.25}) == [("deadline", "0.5", "0.25")]
    assert told({}, {"deadline_s": 2.0}) == [("deadline", "", "2")]


def test_signs_of_life_are_as_many_and_of_the_kind_that_is_asked_for() -> None:
    assert told({"liveliness": "manual_by_topic"}, {"liveliness": "automatic"}) == []
    assert told({"liveliness": ""}, {"liveliness": "manual_by_topic"}) == []
    assert told({"lease_s": 1.0}, {"lease_s": 1.0}) == []
    assert told({"liveliness": "automatic"}, {"liveliness": "manual_by_topic"}) == [
        ("liveliness", "automatic", "manual_by_topic")
    ]
    assert told({"lease_s": 2.0}, {"lease_s": 1.0}) == [("lease", "2", "1")]


def test_every_policy_that_keeps_a_pair_apart_is_told() -> None:
    offer = {"reliability": "best_effort", "deadline_s": None}
    request = {"durability": "transient_local", "deadline_s": 1.0}
    assert len(told(offer, request)) == 3


def test_no_policy_joins_two_types() -> None:
    assert told({"reliability": "best_effort"}, {"type_name": "std_msgs/msg/String"}) == []


def test_each_pair_is_told_also_where_others_hear_each_other() -> None:
    listeners = (PLAIN, end("/a"), end("/b"), BEST_EFFORT)
    found = structural(TopicEnds("/t", (FLOAT,), (BEST_EFFORT, PLAIN), listeners), FLOAT, None)
    assert found.trouble is Trouble.QOS_MISMATCH
    assert found.detail.count("does not hear /camera") == 3
    assert "/b does not hear /camera" in found.detail
    assert (found.facts["subscriber"], found.facts["more"]) == ("/plain", "2")


def test_many_pairs_are_counted_from_some_on_and_twins_told_once() -> None:
    listeners = tuple(end(f"/n{number}") for number in range(8))
    found = structural(TopicEnds("/t", (FLOAT,), (BEST_EFFORT,), listeners), FLOAT, None)
    assert found.detail.endswith("ask for best_effort. (and 3 more pairs)")
    twins = structural(TopicEnds("/t", (FLOAT,), (BEST_EFFORT,), (PLAIN, PLAIN)), FLOAT, None)
    assert twins.detail.count("does not hear") == 1
    assert "more" not in twins.facts


def test_each_trouble_has_its_own_words() -> None:
    nobody = TopicEnds("/t", (FLOAT,), subscribers=(PLAIN,))
    misfit = TopicEnds("/t", (FLOAT,), publishers=(BEST_EFFORT,), subscribers=(PLAIN, end("/b")))
    fine = TopicEnds("/t", (FLOAT,), publishers=(PLAIN,), subscribers=(PLAIN,))
    unknown = UnknownTypeError("foo_msgs/msg/Bar", "foo_msgs", "foo_msgs is not installed")
    assert structural(nobody, FLOAT, None).trouble is Trouble.NO_PUBLISHER
    found = structural(misfit, FLOAT, None)
    assert found.trouble is Trouble.QOS_MISMATCH
    found = structural(fine, "foo_msgs/msg/Bar", unknown)
    assert found.trouble is Trouble.UNKNOWN_TYPE
    assert found.facts["package"] == "foo_msgs"
    assert structural(fine, FLOAT, None).trouble is None
    assert quiet(4.4, ever=True).detail == "no data for 4 s"
    assert quiet(4.4, ever=False).detail == "no data for 4 s, and never before"


def test_our_own_publisher_counts_as_one_for_what_we_show() -> None:
    ours = TopicEnds("/emergency_stop", (FLOAT,), own_publishers=(LATCHED,))
    assert structural(ours, FLOAT, None).trouble is None
    assert ours.is_deserted


def test_a_disagreement_about_the_type_is_a_remark() -> None:
    both = TopicEnds("/t", (FLOAT, "std_msgs/msg/String"), publishers=(PLAIN,))
    found = structural(both, FLOAT, None)
    assert found.trouble is None
    assert found.facts == {"types": f"{FLOAT}, std_msgs/msg/String", "shown": FLOAT}


@pytest.mark.parametrize(
    ("name", "is_ours"),
    [
        ("/rosout", True),
        ("/parameter_events", True),
        ("/drive_to_point/_action/feedback", True),
        ("/_ros2cli_daemon_42", True),
        ("/sonar_front/get_parameters", True),
        ("/sonar_front/get_type_description", True),
        ("/sonar_front/get_logger_levels", True),
        ("/lidar/get_available_transitions", True),
        ("/lidar/change_state", False),
        ("/sonar_front/set_logger_levels", True),
        ("/sensor/sonar_front", False),
        ("/set_head_position", False),
        ("/ai_brain", False),
    ],
)
def test_housekeeping_is_told_from_the_robots_own(name: str, is_ours: bool) -> None:
    assert is_housekeeping(name) is is_ours


def test_full_names_have_one_slash_between_namespace_and_name() -> None:
    assert full_name("sonar", "/") == "/sonar"
    assert full_name("sonar", "/arm") == "/arm/sonar"
