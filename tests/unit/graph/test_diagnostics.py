"""/diagnostics of everybody: read with suspicion, remembered, and laid out as a tree."""

from __future__ import annotations

import math
from typing import Any

import pytest

from graph.data import Sample
from graph.diagnostics.book import HISTORY, MOST, STALE_S, DiagnosticsBook
from graph.diagnostics.reading import LONGEST, MOST_VALUES, StatusLevel, statuses
from graph.diagnostics.tree import DEEPEST, parts, tree
from tests.hostile_text import WORST
from text.plain import is_plain

OK, WARN, ERROR, STALE = StatusLevel.OK, StatusLevel.WARN, StatusLevel.ERROR, StatusLevel.STALE
T0 = 1_700_000_000.0


def status(name: str, level: Any = 0, message: str = "", **values: Any) -> dict[str, Any]:
    told = [{"key": key, "value": value} for key, value in values.items()]
    return {
        "name": name, "level": level, "message": message, "hardware_id": "", "values": told
    }  # fmt: skip


def said(*told: Any, at_s: float = T0) -> Sample:
    kind = "diagnostic_msgs/msg/DiagnosticArray"
    return Sample("/diagnostics", kind, at_s, 0.0, 100, {"status": list(told)})


def book_of(*told: Any) -> DiagnosticsBook:
    book = DiagnosticsBook()
    book.take([said(*told)])
    return book


def drawn(book: DiagnosticsBook) -> list[str]:
    return [f"{'  ' * row.depth}{row.label} {row.level.name}" for row in tree(book.records)]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("chassis", ("chassis",)),
        ("imu: data", ("imu", "data")),
        ("/Robot/Sensors/imu: data", ("Robot", "Sensors", "imu", "data")),
        ("a//b", ("a", "b")),
        ("", ("?",)),
        ("/ : /", ("?",)),
        ("/".join("abcdefghij"), (*"abcdefg", "h/i/j")),
    ],
)
def test_a_name_is_split_as_other_monitors_do(name: str, expected: tuple[str, ...]) -> None:
    assert parts(name) == expected
    assert len(parts("/" * 50_000 + "x/" * 50_000)) == DEEPEST


def test_the_worst_comes_first_and_colours_what_is_above_it() -> None:
    book = book_of(
        status("wheels: left"),
        status("/sensors/imu: data", 3),
        status("/sensors/lidar", 2, "no port"),
        status("/sensors/camera", 1),
        status("battery"),
    )
    assert drawn(book) == [
        "sensors ERROR",
        "  lidar ERROR",
        "  camera WARN",
        "  imu STALE",
        "    data STALE",
        "battery OK",
        "wheels OK",
        "  left OK",
    ]


def test_a_branch_may_have_a_status_of_its_own() -> None:
    rows = tree(book_of(status("arm", 1, "warm"), status("arm/gripper", 2)).records)
    assert [(row.label, row.level) for row in rows] == [("arm", ERROR), ("gripper", ERROR)]
    assert rows[0].record is not None
    assert (rows[0].record.level, rows[0].record.status.message) == (WARN, "warm")
    # One thing under two spellings is as bad as the worse.
    (row,) = tree(book_of(status("arm", 2), status("/arm", 0)).records)
    assert row.level is ERROR


def test_the_history_has_each_change_of_level_and_is_bounded() -> None:
    book = DiagnosticsBook()
    for second in range(10):
        book.take([said(status("imu", 0 if second < 5 else 2, f"at {second}"), at_s=T0 + second)])
    record = book.get("imu")
    assert record is not None
    assert [tuple(change) for change in record.history] == [
        (T0, OK, "at 0"), (T0 + 5, ERROR, "at 5")
    ]  # fmt: skip
    assert record.status.message == "at 9"
    for second in range(3 * HISTORY):
        book.take([said(status("imu", second % 2), at_s=T0 + 20 + second)])
    assert len(record.history) == HISTORY


def test_what_is_not_repeated_is_stale_until_it_is_heard_again() -> None:
    book = book_of(status("imu", 2, "broken"), status("camera"))
    book.take([said(status("camera"), at_s=T0 + 4)])
    book.look(T0 + STALE_S + 0.1)
    assert drawn(book) == ["imu STALE", "camera OK"]
    record = book.get("imu")
    assert record is not None
    assert record.history[-1] == (T0 + STALE_S + 0.1, STALE, "broken")
    book.look(T0 + STALE_S + 0.2)
    assert len(record.history) == 2
    book.take([said(status("imu", 2, "broken"), at_s=T0 + 6)])
    assert [change.level for change in record.history] == [ERROR, STALE, ERROR]


def test_silence_is_excused_while_nobody_listened() -> None:
    book = book_of(status("imu"))
    book.excuse(T0 + 100)
    book.look(T0 + 100 + STALE_S)
    assert drawn(book) == ["imu OK"]
    book.look(T0 + 101 + STALE_S)
    assert drawn(book) == ["imu STALE"]


@pytest.mark.parametrize("level", [77, -1, 255])
def test_a_level_that_does_not_exist_is_an_error(level: int) -> None:
    assert drawn(book_of(status("imu", level))) == ["imu ERROR"]


@pytest.mark.parametrize(
    "broken",
    [
        "text", None, 7, {}, {"name": "x"}, {**status("x"), "values": [{"key": "a"}]},
        {**status("x"), "level": "high"}, {**status("x"), "values": None},
        {**status("x"), "level": math.nan}, {**status("x"), "level": math.inf},
    ],
)  # fmt: skip
def test_what_is_malformed_is_left_out(broken: Any) -> None:
    assert drawn(book_of(broken, status("imu"))) == ["imu OK"]
    assert list(statuses(Sample("/d", "t", T0, 0.0, 1, {"status": "no list"}))) == []


def test_text_from_anywhere_is_printable_and_bounded() -> None:
    told = status(WORST, 1, "m" * 10_000, nan="nan")
    told["values"] += [{"key": f"{WORST}{n}", "value": math.nan} for n in range(1000)]
    (record,) = book_of(told).records
    assert all(map(is_plain, (record.status.name, *record.status.values)))
    assert len(record.status.message) == LONGEST
    assert len(record.status.values) <= MOST_VALUES
    assert record.status.values["nan"] == "nan"


def test_thousands_are_counted_and_laid_out() -> None:
    book = book_of(*(status(f"group{n % 50}/thing{n}", n % 3) for n in range(MOST + 7)))
    assert (len(book.records), book.left_out) == (MOST, 7)
    rows = tree(book.records)
    assert len(rows) == MOST + 50
    book.clear()
    assert (len(book.records), book.left_out) == (0, 0)
