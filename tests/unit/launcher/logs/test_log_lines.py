"""Lines out of bytes: where they end, what is shown of them, and how severe they are."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from launcher.logs.lines import AT_ONCE_S, IDLE_S, MAX_LINE_BYTES, LineAssembler, RawLine, SeverityParser, plain_text
from launcher.status import Severity


def texts(lines: list[RawLine]) -> list[bytes]:
    return [line.data for line in lines]


@given(st.binary(max_size=400), st.lists(st.integers(0, 400), max_size=8))
def test_lines_do_not_depend_on_where_the_pipe_cuts_them(data: bytes, cuts: list[int]) -> None:
    data = data.replace(b"\r", b"") + b"\n"
    assert b"\n".join(texts(fed(data, cuts))) + b"\n" == data


def fed(data: bytes, cuts: list[int]) -> list[RawLine]:
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


def test_of_a_progress_that_rewrites_its_line_the_last_state_counts() -> None:
    assembler = LineAssembler()
    assert assembler.feed(b"10 %\r20 %\r", 0.0) == []
    assert texts(assembler.feed(b"30 %\rdone\n", 0.1)) == [b"30 %", b"done"]


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


@pytest.mark.parametrize(
    ("data", "shown"),
    [
        pytest.param(b"\x1b[31mred\x1b[0m", "red", id="colours are dropped"),
        pytest.param(b"\x1b[38;2;1;2;3mx\x1b[m", "x", id="true colours too"),
        pytest.param(b"50 %\x1b[K", "50 %", id="and what progress bars erase with"),
        pytest.param(b"\x1b]52;c;aGk=\x07", "␛]52;c;aGk=␇", id="the clipboard stays as it was"),
        pytest.param(b"\x1b]0;title\x1b\\", "␛]0;title␛\\", id="and so does the title"),
        pytest.param(b"\x1b[2J\x1b[H", "␛[2J␛[H", id="the screen is not cleared"),
        pytest.param(b"\x1b[31", "␛[31", id="an unfinished sequence ends with its line"),
        pytest.param(b"a\0b\x08c\x7f", "a␀b␈c␡", id="control characters are shown"),
        pytest.param(b"a\tb", "a       b", id="tabs go to columns of eight"),
        pytest.param(b"\xd1\x81\xd1", "с�", id="half a character"),
        pytest.param(b"\xff\xfe", "��", id="no UTF-8 at all"),
        pytest.param("\x9b31m".encode(), "�31m", id="the other set of control characters"),
        pytest.param("abc\u202edcba".encode(), "abc�dcba", id="text is not turned round"),
        pytest.param(b"[red]x[/red] [/]", "[red]x[/red] [/]", id="markup is text"),
    ],
)
def test_what_is_shown(data: bytes, shown: str) -> None:
    assert plain_text(data)[0] == shown


@given(st.binary(max_size=300))
def test_no_bytes_whatever_lead_to_a_control_character(data: bytes) -> None:
    text, _severity = plain_text(data)
    assert not [c for c in text if ord(c) < 0x20 or 0x7F <= ord(c) < 0xA0]


@given(st.text(st.characters(codec="ascii", categories=("L", "N", "P", "S", "Zs"))))
def test_plain_text_comes_through_unchanged(text: str) -> None:
    assert plain_text(text.encode()) == (text, None)


NOW = 1_700_000_500.0


def severities(*lines: str) -> list[Severity]:
    parser = SeverityParser()
    return [parser.parse(line, NOW).severity for line in lines]


def test_the_format_of_rcutils() -> None:
    line = "[WARN] [1700000000.123456789] [robot.sonar]: [red] too close: 0.3 m"
    parsed = SeverityParser().parse(line, NOW)
    assert parsed.severity is Severity.WARN
    assert parsed.time_s == pytest.approx(1_700_000_000.123456789)
    assert parsed.logger == "robot.sonar"
    assert parsed.text == "[red] too close: 0.3 m"


@pytest.mark.parametrize("stamp", ["0.5", "120.000000000", "999999999999.9"])
def test_a_stamp_that_is_no_wall_clock_gives_way_to_the_time_of_reading(stamp: str) -> None:
    assert SeverityParser().parse(f"[INFO] [{stamp}] [x]: y", NOW).time_s == NOW


def test_the_further_lines_of_a_message_have_its_severity_and_logger() -> None:
    parser = SeverityParser()
    parser.parse("[ERROR] [1700000000.0] [arm]: joints:", NOW)
    second = parser.parse("  elbow 12", NOW + AT_ONCE_S / 2)
    assert (second.severity, second.logger) == (Severity.ERROR, "arm")


def test_a_traceback_is_an_error_to_its_last_line_and_not_beyond() -> None:
    lines = (
        "Traceback (most recent call last):",
        '  File "x.py", line 1, in <module>',
        "    1 / 0",
        "ZeroDivisionError: division by zero",
        "",
        "During handling of the above exception, another exception occurred:",
        "",
        "Traceback (most recent call last):",
        '  File "x.py", line 3, in <module>',
        "KeyError: 'x'",
    )
    assert severities(*lines) == [Severity.ERROR] * len(lines)
    after = severities(*lines, "[INFO] [1700000000.0] [x]: on we go")
    assert after[-1] is Severity.INFO
