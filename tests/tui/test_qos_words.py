"""What keeps two endpoints apart, in sentences that name both and what each could change."""

from __future__ import annotations

import pytest

from graph.data import EndpointInfo
from graph.qos_fit import mismatches
from tui.i18n import set_language
from tui.widgets.qos_words import misfit_words, pair_words


def facts(**values: str) -> dict[str, str]:
    return {"publisher": "/lidar", "subscriber": "/brain", **values}


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (
            {"policy": "liveliness", "offered": "automatic", "requested": "manual_by_topic"},
            (
                "/brain does not hear /lidar: liveliness manual_by_topic is asked for, automatic is "
                "offered. Let /lidar offer manual_by_topic, or let /brain ask for automatic."
            ),
        ),
        (
            {"policy": "deadline", "offered": "0.5", "requested": "0.25"},
            (
                "/brain does not hear /lidar: it asks for a message at least every 250 ms (deadline), "
                "500 ms is offered. Let /lidar offer 250 ms or less, or let /brain ask for 500 ms or "
                "more."
            ),
        ),
        (
            {"policy": "deadline", "offered": "", "requested": "2"},
            (
                "/brain does not hear /lidar: it asks for a message at least every 2.0 s (deadline), "
                "no deadline is offered. Let /lidar offer 2.0 s or less, or let /brain ask for none."
            ),
        ),
        (
            {"policy": "lease", "offered": "", "requested": "2"},
            (
                "/brain does not hear /lidar: it asks for a sign of life at least every 2.0 s "
                "(liveliness lease duration), none is offered. Let /lidar offer 2.0 s or less, or let "
                "/brain ask for none."
            ),
        ),
    ],
)
def test_each_policy_has_its_own_words(values: dict[str, str], words: str) -> None:
    assert pair_words(facts(**values)) == words


def test_further_pairs_are_counted() -> None:
    one = facts(policy="durability", offered="volatile", requested="transient_local")
    assert misfit_words({**one, "more": "2"}).endswith("ask for volatile. … and 2 more pairs")
    assert misfit_words(one).endswith("ask for volatile.")


def test_hostile_names_are_shown_harmlessly() -> None:
    words = pair_words(
        facts(policy="reliability", offered="best_effort", requested="reliable")
        | {"publisher": "/\x1b[31m{x}[b]"}
    )
    assert "␛[31m{x}[b]" in words


def test_every_policy_that_is_found_is_told_in_russian_too() -> None:
    offer = EndpointInfo("/p", "t", "best_effort", "volatile", liveliness="automatic")
    asked = EndpointInfo(
        "/s", "t", "reliable", "transient_local",
        deadline_s=1.0, lease_s=1.0, liveliness="manual_by_topic",
    )  # fmt: skip
    set_language("ru")
    try:
        told = [pair_words(found.facts()) for found in mismatches([offer], [asked])]
    finally:
        set_language("en")
    assert len(told) == 5
    assert all(words.startswith("/s не слышит /p: ") and "Пусть /p" in words for words in told)
