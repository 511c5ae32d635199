"""Bytes of a pipe become lines: wherever they are cut, however long they are."""

from __future__ import annotations

import re

from hypothesis import example, given
from hypothesis import strategies as st

from launcher.logs.lines import IDLE_S, MAX_LINE_BYTES, LineAssembler, RawLine


def texts(lines: list[RawLine]) -> list[bytes]:
    return [line.data for line in lines]


@given(st.binary(max_size=400), st.lists(st.integers(0, 400), max_size=8))
def test_lines_do_not_depend_on_where_the_pipe_cuts_them(data: bytes, cuts: list[int]) -> None:
    data = data.replace(b"\r", b"") + b"\n"
    assert b"\n".join(texts(fed(data, cuts))) + b"\n" == data


@example("\r ", [1])
@given(st.text("ab1 \r\n", max_size=40), st.lists(st.integers(0, 40), max_size=8))
def test_nor_do_lines_with_carriage_returns(text: str, cuts: list[int]) -> None:
    data = text.encode() + b"\n"
    lines = fed(data, cuts)
    assert lines == fed(data, [])
    # Of a state that comes again with other numbers one is enough.
    kept = "".join("".join(filter(str.isalpha, line.data.decode())) for line in lines)
    alone = [part for part in re.split("[\r\n]", "".join(re.findall("[ab\r\n]", text))) if part]
    for part in alone:
        assert part in kept


def fed(data: bytes, cuts: list[int]) -> list[RawLine]:
    """Return the lines of `data` that comes in pieces."""
    assembler = LineAssembler()
    lines = []
    begin = 0
    for cut in [*sorted(cuts), len(data)]:
        lines += assembler.feed(data[begin:cut], 0.0)
        begin = max(begin, min(cut, len(data)))
    return lines


def test_a_line_of_a_megabyte_is_cut_and_says_how_much_is_missing() -> None:
    assembler = LineAssembler()
    lines = []
    for _chunk in range(16):
        lines += assembler.feed(b"x" * 65536, 0.0)
    lines += assembler.feed(b"tail\nnext\n", 0.0)
    assert texts(lines) == [b"x" * MAX_LINE_BYTES, b"next"]
    assert lines[0].lost == 16 * 65536 + 4 - MAX_LINE_BYTES
    assert lines[1].lost == 0


def test_a_line_without_an_end_takes_no_more_memory_than_is_shown_of_it() -> None:
    assembler = LineAssembler()
    for _chunk in range(100):
        assembler.feed(b"\x1b]52;c;" + b"A" * 65536, 0.0)
    (line,) = assembler.flush(0.0, at_end=True)
    assert len(line.data) == MAX_LINE_BYTES


def test_windows_line_ends_leave_nothing_behind() -> None:
    assert texts(LineAssembler().feed(b"one\r\ntwo\r\n", 0.0)) == [b"one", b"two"]


def test_of_a_progress_that_rewrites_its_line_the_last_state_counts() -> None:
    assembler = LineAssembler()
    assert assembler.feed(b"10 %\r20 %\r", 0.0) == []
    assert texts(assembler.feed(b"30 %\rdone\n", 0.1)) == [b"30 %", b"done"]


def test_a_carriage_return_keeps_what_stood_before_it() -> None:
    feed = LineAssembler().feed
    assert texts(feed(b"camera opened\rno frames\n", 0.0)) == [b"camera opened", b"no frames"]
    russian = "камера открыта\rкадров нет\n".encode()
    assert texts(LineAssembler().feed(russian, 0.0)) == russian.strip().split(b"\r")


def test_what_only_erases_a_line_is_none() -> None:
    lines = LineAssembler().feed(b"\r 50 %|##  |\r100 %|####|\r\x1b[K\r      \rsaved\n\r\n", 0.0)
    assert texts(lines) == [b"100 %|####|", b"saved", b""]


def test_what_was_rewritten_is_not_held_back_by_what_waits() -> None:
    assembler = LineAssembler()
    assert texts(assembler.feed(b"opening\rwaiting\rfor the fi", 0.0)) == [b"opening"]
    assert texts(assembler.flush(IDLE_S)) == [b"waiting"]
    assert texts(assembler.feed(b"rst\n", 1.5 * IDLE_S)) == [b"for the first"]


def test_the_end_brings_both_the_state_before_and_the_last() -> None:
    assembler = LineAssembler()
    assembler.feed(b"98 %\r99 %\rdied", 0.0)
    assert texts(assembler.flush(0.0, at_end=True)) == [b"99 %", b"died"]
    assert not assembler.unfinished


def test_a_progress_without_an_end_is_shown_now_and_then_and_takes_no_memory() -> None:
    assembler = LineAssembler()
    for step in range(10_000):
        assert assembler.feed(b"%d steps\r" % step, step / 10_000) == []
    assert texts(assembler.flush(IDLE_S)) == [b"9999 steps"]
    assert assembler.flush(2 * IDLE_S) == []


def test_a_prompt_is_shown_after_a_while_though_its_line_has_no_end() -> None:
    assembler = LineAssembler()
    assembler.feed(b"Continue? ", 5.0)
    assert assembler.flush(5.0 + IDLE_S / 2) == []
    assert texts(assembler.flush(5.0 + IDLE_S)) == [b"Continue? "]
    assert texts(assembler.feed(b"yes\n", 9.0)) == [b"yes"]


def test_half_a_character_waits_for_its_other_half() -> None:
    assembler = LineAssembler()
    word = "стоп".encode()
    assembler.feed(word[:-1], 0.0)
    (shown,) = assembler.flush(IDLE_S)
    assert shown.data.decode() == "сто"
    assert texts(assembler.feed(word[-1:] + b"\n", 2.0)) == ["п".encode()]


def test_the_last_line_needs_no_end_when_the_stream_ends() -> None:
    assembler = LineAssembler()
    assembler.feed(b"last words", 0.0)
    assert texts(assembler.flush(0.0, at_end=True)) == [b"last words"]
