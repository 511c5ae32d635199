"""What keeps two endpoints apart, in sentences that name both and what each could change."""

from __future__ import annotations

import pytest

from graph.data import EndpointInfo
from graph.qos_compatibility import mismatches
from text.i18n import set_language
from tui.widgets.qos_words import misfit_words, pair_words


def facts(**values: str) -> dict[str, str]:
    return {"publisher": "/lidar", "subscriber": "/brain", **values}


APART = "/brain does not hear /lidar: "
LIFE = "it asks for a sign of life at least every 2 s (liveliness lease duration), "


@pytest.mark.parametrize(
    ("policy", "offered", "requested", "why", "way_out"),
    [
        (
            "liveliness", "automatic", "manual_by_topic",
            "liveliness manual_by_topic is asked for, automatic is offered.",
            " Let /lidar offer manual_by_topic, or let /brain ask for automatic.",
        ),
        (
            "deadline", "0.5", "0.25",
            "it asks for a message at least every 0.25 s (deadline), 0.5 s is offered.",
            " Let /lidar offer 0.25 s or less, or let /brain ask for 0.5 s or more.",
        ),
        (
            "deadline", "", "2",
            "it asks for a message at least every 2 s (deadline), nothing is offered.",
            " Let /lidar offer 2 s or less, or let /brain ask for none.",
        ),
        (
            "lease", "", "2",
            LIFE + "nothing is offered.",
            " Let /lidar offer 2 s or less, or let /brain ask for none.",
        ),
        (
            "lease", "3", "2",
            LIFE + "3 s is offered.",
            " Let /lidar offer 2 s or less, or let /brain ask for 3 s or more.",
        ),
    ],
)  # fmt: skip
def test_each_policy_has_its_own_words(
    policy: str, offered: str, requested: str, why: str, way_out: str
) -> None:
    values = facts(policy=policy, offered=offered, requested=requested)
    assert misfit_words(values) == APART + why + way_out


def test_every_policy_that_is_found_is_told_in_russian_too() -> None:
    offer = EndpointInfo("/p", "t", "best_effort", "volatile", liveliness="automatic")
    asked = EndpointInfo(
        "/s", "t", "reliable", "transient_local",
        deadline_s=1.0, lease_s=1.0, liveliness="manual_by_topic",
    )  # fmt: skip
    set_language("ru")
    try:
        told = [pair_words(found) for found in mismatches([offer], [asked])]
    finally:
        set_language("en")
    assert len(told) == 5
    assert all(words.startswith("/s не слышит /p: ") and "Пусть /p" in words for words in told)
