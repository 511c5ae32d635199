"""The newest lines of a node are kept, and never more than there is room for."""

from __future__ import annotations

from launcher.logs.ring import LINE_COST, LogRing
from launcher.status import LogLine, Severity


def fill(ring: LogRing, count: int, text: str = "x") -> None:
    for _line in range(count):
        ring.append(LogLine("sonar", ring.last_seq + 1, 0.0, Severity.INFO, text))


def test_the_oldest_lines_go_when_there_are_too_many() -> None:
    ring = LogRing(max_lines=10)
    fill(ring, 25)
    assert [line.seq for line in ring.newest(100)] == list(range(16, 26))


def test_long_lines_leave_room_for_fewer() -> None:
    ring = LogRing(max_lines=1000, max_bytes=20 * (LINE_COST + 1000))
    fill(ring, 100, "x" * 1000)
    assert len(ring) == 20


def test_one_line_beyond_all_bounds_leaves_nothing_and_harms_nothing() -> None:
    ring = LogRing(max_bytes=1000)
    fill(ring, 3)
    fill(ring, 1, "x" * 5000)
    fill(ring, 1)
    assert [line.seq for line in ring.newest(10)] == [5]


def test_newest_lines_come_oldest_first() -> None:
    ring = LogRing()
    fill(ring, 9)
    assert [line.seq for line in ring.newest(3)] == [7, 8, 9]
    assert ring.newest(0) == []


def test_a_reader_gets_what_came_after_what_it_has_seen() -> None:
    ring = LogRing()
    fill(ring, 9)
    assert [line.seq for line in ring.after(6, limit=100, max_chars=10_000)] == [7, 8, 9]
    assert ring.after(9, limit=100, max_chars=10_000) == []


def test_a_reader_far_behind_gets_the_newest_within_its_bounds() -> None:
    ring = LogRing()
    fill(ring, 100, "x" * 100)
    assert [line.seq for line in ring.after(0, limit=5, max_chars=10_000)] == [96, 97, 98, 99, 100]
    assert [line.seq for line in ring.after(0, limit=50, max_chars=250)] == [99, 100]


def test_a_reader_of_lines_that_are_gone_gets_what_is_left() -> None:
    ring = LogRing(max_lines=5)
    fill(ring, 20)
    assert [line.seq for line in ring.after(3, limit=100, max_chars=1000)] == list(range(16, 21))
