"""What a log view keeps: bounded, fair to quiet nodes, honest about what is missing."""

from __future__ import annotations

from collections import Counter

from launcher.status import LogLine, Severity
from tui.log_view.ring import LONGEST_TEXT, LineRing


def line(node: str, seq: int, text: str = "hello", severity: Severity = Severity.INFO) -> LogLine:
    return LogLine(node, seq, 1_700_000_000.0 + seq, severity, text)


def fill(ring: LineRing, node: str, first: int, count: int, text: str = "hello") -> None:
    ring.append([line(node, seq, text) for seq in range(first, first + count)], {})
    if ring.full:
        ring.trim()


def test_a_flood_of_one_node_leaves_the_lines_of_the_others() -> None:
    ring = LineRing(max_lines=1000)
    fill(ring, "quiet", 1, 50)
    for batch in range(40):
        fill(ring, "noisy", 1 + batch * 500, 500)
    kept = Counter(entry.node for entry in ring.entries)
    assert kept["quiet"] == 50
    assert len(ring.entries) <= 1250
    assert ring.entries[-1].text == "hello"


def test_memory_is_bounded_in_bytes_too() -> None:
    ring = LineRing(max_lines=20_000, max_bytes=1_000_000)
    for batch in range(30):
        fill(ring, "noisy", 1 + batch * 20, 20, "x" * 10_000)
        assert sum(entry.size for entry in ring.entries) <= 1_250_000 + 20 * 10_300
    assert ring.entries[-1].id == 599


def test_a_line_of_a_megabyte_is_cut_and_says_so() -> None:
    ring = LineRing()
    (entry,) = ring.append([line("noisy", 1, "x" * 1_000_000)], {})
    assert len(entry.text) < LONGEST_TEXT + 30
    assert entry.text.endswith(f"(+{1_000_000 - LONGEST_TEXT})")


def test_a_gap_in_the_numbers_is_marked_where_it_is() -> None:
    ring = LineRing()
    ring.append([line("a", 1), line("b", 7)], {})
    entries = ring.append([line("b", 8), line("a", 12)], {"a": 10})
    assert [(entry.node, entry.skipped) for entry in entries] == [("b", 0), ("a", 10), ("a", 0)]


def test_what_somebody_reads_is_not_dropped_and_the_gap_behind_it_is_marked() -> None:
    ring = LineRing(max_lines=100)
    fill(ring, "noisy", 1, 100)
    read = list(ring.entries)
    ring.hold()
    for batch in range(10):
        fill(ring, "noisy", 101 + batch * 100, 100)
    assert ring.entries[:100] == read
    assert len(ring.entries) <= 100 + 126
    mark = ring.entries[100]
    assert mark.skipped == 1000 - (len(ring.entries) - 101)
    ring.release()
    ring.trim()
    assert len(ring.entries) == 100
    assert ring.entries[-1].id == 1099


def test_control_characters_become_their_pictures() -> None:
    ring = LineRing()
    (entry,) = ring.append([line("a", 1, "\x1b]52;c;AAAA\x07 \x00 \ud800 [red]x[/red]")], {})
    assert entry.text == "␛]52;c;AAAA␇ ␀ � [red]x[/red]"
