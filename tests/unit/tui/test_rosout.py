"""Lines of /rosout as lines of the log."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.data import Sample
from launcher.status import Severity
from tui.session.rosout import TOPIC, RosoutReader


def message(**value: Any) -> Sample:
    return Sample(TOPIC, "rcl_interfaces/msg/Log", 1000.0, 0.0, 100, value)


def log(text: str, name: str = "talker", level: int = 20) -> Sample:
    stamp = {"sec": 900, "nanosec": 500_000_000}
    return message(stamp=stamp, level=level, name=name, msg=text, file="", function="", line=1)


def test_a_message_is_a_line_of_its_node_with_the_node_s_own_time() -> None:
    reader = RosoutReader()
    one, two, other = reader.lines([log("a"), log("b"), log("c", name="listener")])
    assert (one.node, one.seq, one.text, one.time_s) == ("talker", 1, "a", 900.5)
    assert (two.seq, other.seq) == (2, 1)
    assert one.logger == "talker"


@pytest.mark.parametrize(
    ("level", "severity"),
    [
        (10, Severity.DEBUG),
        (20, Severity.INFO),
        (30, Severity.WARN),
        (40, Severity.ERROR),
        (50, Severity.FATAL),
        (0, Severity.DEBUG),
        (255, Severity.FATAL),
        (25, Severity.INFO),
    ],
)
def test_every_level_has_a_severity(level: int, severity: Severity) -> None:
    assert RosoutReader().lines([log("x", level=level)])[0].severity is severity


def test_hostile_text_is_one_harmless_line() -> None:
    (line,) = RosoutReader().lines([log("a\x1b[2J\nb", name="\x1b]0;x")])
    assert line.text == "a␛[2J␊b"
    assert line.node == "␛]0;x"


def test_what_is_no_log_is_left_out() -> None:
    assert RosoutReader().lines([message(data=1.0)]) == ()


@given(st.dictionaries(st.sampled_from(["stamp", "level", "name", "msg"]), st.none() | st.text()))
def test_a_topic_of_that_name_with_anything_in_it_breaks_nothing(value: dict[str, Any]) -> None:
    for line in RosoutReader().lines([message(**value)]):
        assert line.time_s == 1000.0
