"""Digits at any size: they fill their room, differ from each other, and do not jump."""

from __future__ import annotations

import pytest

from tui.wall.digits import digit_lines, size_for

SIGNS = "0123456789e-.,∞"
SMALLEST = """\
█▀█   █ ▀▀█ ▀▀█ █ █ █▀▀ █▀▀ ▀▀█ █▀█ █▀█
█ █   █ █▀▀ ▀▀█ ▀▀█ ▀▀█ █▀█   █ █▀█ ▀▀█
█▄█   █ █▄▄ ▄▄█   █ ▄▄█ █▄█   █ █▄█ ▄▄█"""


def test_the_smallest_digits_are_three_rows_high() -> None:
    size = size_for(("0123456789",), 39, 3)
    assert size is not None
    assert "\n".join(digit_lines("0123456789", size)) == SMALLEST
    assert size_for(("0123456789",), 38, 9) is None
    assert size_for(("0",), 80, 2) is None


@pytest.mark.parametrize(("columns", "rows"), [(18, 3), (37, 13), (77, 23), (77, 10), (200, 50)])
@pytest.mark.parametrize("text", ["0.30", "-12,5", "∞", "---", "1e308", ""])
def test_they_fit_and_fill_what_room_there_is(text: str, columns: int, rows: int) -> None:
    size = size_for((text,), columns, rows)
    if size is None:
        assert (columns, text) == (18, "1e308")
        return
    lines = digit_lines(text, size)
    assert len(lines) <= rows
    assert len({len(line) for line in lines}) == 1
    assert len(lines[0]) <= columns
    wider = len(digit_lines(text, size._replace(high=size.high + 2, wide=size.wide + 2))[0])
    assert len(lines) == rows or wider > columns


@pytest.mark.parametrize("rows", [3, 4, 7, 14, 30])
def test_no_two_signs_look_alike(rows: int) -> None:
    size = size_for(("0",), 200, rows)
    assert size is not None
    assert len({tuple(digit_lines(sign, size)) for sign in SIGNS}) == len(SIGNS)
