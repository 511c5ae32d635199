"""Which lines are shown and on which rows: the same whether built at once or line by line."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from rich.cells import cell_len

from launcher.status import LogLine, Severity
from tui.log_view.filter import LogFilter
from tui.log_view.index import LogIndex, folded, folded_rows
from tui.log_view.ring import LineRing, LogEntry
from tui.log_view.rows import text_of

TEXTS = (
    "",
    "short",
    "a much longer text that needs folding",
    "Путь свободен до препятствия",
    "🧠🎙️",
)


def entries(count: int = 60) -> list[LogEntry]:
    lines = [
        LogLine(
            f"node{n % 3}", 1 + n // 3, 0.0, list(Severity)[n % 5], f"{TEXTS[n % 5]} {n}".strip()
        )
        for n in range(count)
    ]
    return LineRing().append(lines, {"node1": 4})


FILTERS = [
    LogFilter(),
    LogFilter(muted=frozenset({"node1"})),
    LogFilter(only="node2", muted=frozenset({"node2"})),
    LogFilter(minimum=Severity.ERROR),
    LogFilter(search="FOLD"),
    LogFilter(search="путь", only_found=True),
    LogFilter(search="no such text", only_found=True),
]


@pytest.mark.parametrize("width", [None, 8, 13, 30])
@pytest.mark.parametrize("chosen", FILTERS)
def test_growing_line_by_line_gives_what_building_at_once_gives(
    chosen: LogFilter, width: int | None
) -> None:
    grown, built = LogIndex(text_of), LogIndex(text_of)
    for index in (grown, built):
        index.filter = chosen
        index.fold(width)
    for entry in entries():
        grown.extend([entry])
    built.rebuild(entries())
    assert [entry.id for entry in grown.shown] == [entry.id for entry in built.shown]
    assert (grown.rows, grown.found) == (built.rows, built.found)


def test_dropped_lines_leave_the_rest_on_the_rows_of_a_new_index() -> None:
    index, fresh = LogIndex(text_of), LogIndex(text_of)
    whole = entries()
    for each in (index, fresh):
        each.filter = LogFilter(search="5")
        each.fold(9)
    index.rebuild(whole)
    for entry in whole[:20]:
        entry.dropped = True
    index.prune()
    fresh.rebuild(whole[20:])
    assert (index.shown, index.found, index.rows) == (fresh.shown, fresh.found, fresh.rows)
    assert [index.locate(row) for row in range(index.rows)] == [
        fresh.locate(row) for row in range(fresh.rows)
    ]


def test_the_search_goes_around_the_ends() -> None:
    index = LogIndex(text_of)
    index.filter = LogFilter(search="folding")
    index.rebuild(entries())
    first, second, *_rest, last = index.found
    assert index.found_near(first, 1) == second
    assert index.found_near(last, 1) == first
    assert index.found_near(first, -1) == last
    assert index.found_number(second) == 2
    assert index.found_number(None) == 0


def test_only_one_node_and_back_to_what_was_muted() -> None:
    muted = LogFilter().toggled("a").toggled("b").toggled("a")
    alone = muted.alone("b")
    assert [node for node in "abc" if alone.shows_node(node)] == ["b"]
    assert alone.alone("b") == muted
    assert [node for node in "abc" if muted.shows_node(node)] == ["a", "c"]


ALPHABET = st.sampled_from("ab ё—\u0301你🧠\ufe0f\u200d🎙")


@example("\u200daaa🧠🧠🧠", 8)
@example("\u200d\u200d" + "a" * 10 + "🧠", 8)
@given(st.text(ALPHABET, max_size=60), st.integers(8, 20))
def test_folding_keeps_every_character_and_no_row_is_too_wide(text: str, width: int) -> None:
    pieces = folded(text, width)
    assert "".join(pieces) == text
    assert all(cell_len(piece.removesuffix(" ")) <= width for piece in pieces)
    assert folded_rows(text, width) == len(pieces)
