"""Lines of before and lines as they come: each once, and nothing said to be missing that is not."""

from __future__ import annotations

import pytest

from launcher.client.log_history import newer
from launcher.events import LogEvent
from launcher.status import LogLine, Severity


def line(seq: int, node: str = "sonar") -> LogLine:
    return LogLine(node, seq, 0.0, Severity.INFO, "x")


def lines(first: int, last: int, node: str = "sonar") -> tuple[LogLine, ...]:
    return tuple(line(seq, node) for seq in range(first, last + 1))


@pytest.mark.parametrize(
    ("known", "event", "expected"),
    [
        ({}, LogEvent(lines(1, 3), {"sonar": 2}), LogEvent(lines(1, 3), {"sonar": 2})),
        ({"sonar": 5}, LogEvent(lines(4, 7)), LogEvent(lines(6, 7))),
        ({"sonar": 5}, LogEvent(lines(6, 7)), LogEvent(lines(6, 7))),
        ({"sonar": 9}, LogEvent(lines(4, 7)), LogEvent(())),
        ({"sonar": 5}, LogEvent(lines(1, 2, "gate")), LogEvent(lines(1, 2, "gate"))),
    ],
    ids=["nothing known", "overlap", "joint", "all known", "another node"],
)
def test_what_is_known_does_not_come_again(
    known: dict[str, int], event: LogEvent, expected: LogEvent
) -> None:
    assert newer(event, known) == expected


@pytest.mark.parametrize(
    ("known", "first", "skipped", "missing"),
    [
        (100, 301, 250, {"sonar": 200}),
        (100, 301, 200, {"sonar": 200}),
        (100, 101, 50, {}),
        (400, 301, 200, {}),
        (600, 301, 200, {}),
    ],
    ids=["some of them known", "none known", "all known", "and of the rest", "and the rest"],
)
def test_lines_left_out_are_missing_only_if_they_are_not_known(
    known: int, first: int, skipped: int, missing: dict[str, int]
) -> None:
    event = LogEvent(lines(first, first + 199), {"sonar": skipped})
    assert newer(event, {"sonar": known}).skipped == missing
