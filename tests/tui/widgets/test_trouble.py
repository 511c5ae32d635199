"""What keeps two endpoints apart, in sentences; and a form whose type is not there."""

from __future__ import annotations

import pytest

from graph.qos import Mismatch
from tests.tui.panel_stage import Bare
from tests.waiting import until
from tui.widgets.trouble import pair_words
from tui.yaml_form.form import YamlForm


async def test_a_type_that_is_not_there_says_so() -> None:
    form = YamlForm("nope_msgs/msg/Thing")
    async with Bare(form).run_test(size=(80, 24)):
        await until(lambda: form.error is not None, "the error")
        assert "package nope_msgs is not installed" in form.verdict
        assert form.value is None


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
            "lease", "3", "2",
            LIFE + "3 s is offered.",
            " Let /lidar offer 2 s or less, or let /brain ask for 3 s or more.",
        ),
    ],
)  # fmt: skip
def test_each_policy_has_its_own_words(policy: str, offered: str, requested: str, why: str, way_out: str) -> None:
    assert pair_words(Mismatch(policy, "/lidar", "/brain", offered, requested)) == APART + why + way_out
