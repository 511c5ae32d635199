"""All lines come back as they were, and thousands of them take little memory."""

from __future__ import annotations

import gc
from itertools import islice

from launcher.logs.kept_lines import BLOCK_LINES, KeptLines
from launcher.logs.ring import LogRing
from launcher.status import LogLine, Severity
from text.sentences import Words, say

MANY = 5 * BLOCK_LINES


def numbered(number: int) -> LogLine:
    text = f"Препятствие в {number / 100:.2f} м\udcff"
    return LogLine("sonar", number, 1.7e9 + number / 3, Severity.WARN, text, "sonar.gate", "stdout")


def test_lines_come_back_as_they_were() -> None:
    lines = [numbered(number) for number in range(MANY)]
    words = say("{count} nodes", count=4)
    lines[3] = LogLine("deck", 3, 0.1, Severity.INFO, words, source="deck")
    kept = KeptLines()
    for line in lines:
        kept.append(line)
    assert len(kept) == MANY
    again = list(reversed(kept))[::-1]
    assert again == lines
    assert isinstance(again[3].text, Words)
    assert list(islice(reversed(kept), 3)) == lines[:-4:-1]


def test_the_oldest_go_first_and_are_counted() -> None:
    kept = KeptLines()
    for number in range(MANY):
        kept.append(numbered(number))
    gone = characters = 0
    while len(kept) > BLOCK_LINES:
        lines, length = kept.drop_oldest()
        gone, characters = gone + lines, characters + length
        assert [line.seq for line in reversed(kept)] == list(range(gone, MANY))[::-1]
    assert characters == sum(len(numbered(number).text) for number in range(gone))


def test_a_ring_of_thousands_has_hundreds_of_objects() -> None:
    ring = LogRing(max_lines=20 * BLOCK_LINES)
    for number in range(50 * BLOCK_LINES):
        ring.append(numbered(number + 1))
    assert 19 * BLOCK_LINES <= len(ring) <= 20 * BLOCK_LINES
    assert [line.seq for line in ring.newest(3)] == [50 * BLOCK_LINES - 2 + at for at in range(3)]
    kept = [each for each in gc.get_objects() if isinstance(each, LogLine) and each.node == "sonar"]
    assert len(kept) <= 2 * BLOCK_LINES + 3
