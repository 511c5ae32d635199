"""Who cannot hear whom, and what Deck asks for so that it hears everybody."""

from __future__ import annotations

import pytest

from graph.data import EndpointInfo, Trouble
from graph.housekeeping import is_housekeeping
from graph.qos import Qos, mismatches, to_be_heard, to_hear
from graph.scan import TopicEnds, full_name
from graph.troubles import quiet, structural
from graph.types import UnknownTypeError

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
    assert found.in_words() == (
        "/vlm does not hear /camera: it asks for reliability reliable, offered is best_effort. "
        "Make the publisher reliable or the subscriber best_effort"
    )
    (found,) = mismatches([PLAIN], [LATCHED])
    assert found.facts() == {
        "policy": "durability",
        "publisher": "/plain",
        "subscriber": "/map",
        "offered": "volatile",
        "requested": "transient_local",
    }


def test_each_trouble_has_its_own_words() -> None:
    nobody = TopicEnds("/t", (FLOAT,), subscribers=(PLAIN,))
    misfit = TopicEnds("/t", (FLOAT,), publishers=(BEST_EFFORT,), subscribers=(PLAIN, end("/b")))
    fine = TopicEnds("/t", (FLOAT,), publishers=(PLAIN,), subscribers=(PLAIN,))
    unknown = UnknownTypeError("foo_msgs/msg/Bar", "foo_msgs", "foo_msgs is not installed")
    assert structural(nobody, FLOAT, None).trouble is Trouble.NO_PUBLISHER
    found = structural(misfit, FLOAT, None)
    assert found.trouble is Trouble.QOS_MISMATCH
    assert found.detail.endswith("(and 1 more pairs)")
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
