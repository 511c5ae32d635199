"""Nothing that a node prints is ever obeyed by a terminal, and nothing of it is lost."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from launcher.logs.text import plain_text
from launcher.status import Severity


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


@pytest.mark.parametrize(
    ("data", "severity"),
    [
        (b"\x1b[31mbad", Severity.ERROR),
        (b"\x1b[0m\x1b[1;31mbad", Severity.ERROR),
        (b"\x1b[1;91mbad", Severity.ERROR),
        (b"\x1b[33mhm", Severity.WARN),
        (b"\x1b[32mgood", None),
    ],
)
def test_a_colour_suggests_a_severity(data: bytes, severity: Severity | None) -> None:
    assert plain_text(data)[1] == severity
