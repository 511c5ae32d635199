"""The emergency stop is found in the bytes, whatever else has come or is missing."""

from __future__ import annotations

import pytest

from tui.terminal.stop_scan import UNFINISHED_S, StopScan

SPACE, CTRL_X = b" ", b"\x18"
PASTE, END = b"\x1b[200~", b"\x1b[201~"
ARROWS = 1000 * b"\x1b[A"


class Typist:
    """Types into a scan, on a clock that moves only when told to."""

    def __init__(self, *stops: str) -> None:
        self.stops = set(stops or ("space", "ctrl+x"))
        self.now_s = 0.0
        self.scan = StopScan(lambda key: key in self.stops, lambda: self.now_s)

    def type(self, data: bytes) -> int:
        """Return how many stops are seen at once."""
        return sum(stops for _piece, stops in self.scan.cut(data))

    def wait(self, seconds: float = UNFINISHED_S) -> bool:
        """Return whether a stop is seen after that time."""
        self.now_s += seconds
        return self.scan.overdue()


@pytest.mark.parametrize(
    "key",
    [
        SPACE,
        CTRL_X,
        b"\x1b[32u",
        b"\x1b[32;1u",
        b"\x1b[32;;32u",
        b"\x1b[120;5u",
        b"\x1bO ",
        b"\x1b ",
        b"\x1b\x1b ",
        b"\x1b\x18",
        b"\x1b[\x18",
        b"\x1b[1;\x18",
        b"\x1bO\x18",
        b"\x1b]0;title\x18",
        b"\x1bP1$r\x18",
    ],
)
@pytest.mark.parametrize("before", [b"", ARROWS, b"hello\r", "Привет".encode(), b"\x1b[M !!"])
def test_a_stop_key_counts_at_once_whatever_came_before(key: bytes, before: bytes) -> None:
    assert Typist().type(before + key) == 1


def test_it_is_found_however_the_bytes_are_cut() -> None:
    typist = Typist()
    assert [typist.type(bytes((byte,))) for byte in b"\x1b[120;5u"] == [0] * 7 + [1]


@pytest.mark.parametrize(
    "text",
    [
        "слово".encode(),
        b"\x1b[A\x1b[1;5C\x1bOP\x1b[15~",
        b"\x1b[<0;12;7M\x1b[<0;12;7m",
        b"\x1b[M !!\x1b[M#!!",
        b"\x1b[?2026;2$y\x1b[2 q",
        b"\x1b]11;rgb:0 0/0 0/0 0\x07\x1b]10;a b\x1b\\\x1bP>|XTerm (370)\x1b\\",
        PASTE + b"a b\x18 c" + END,
        PASTE + b"\x1b[120;5u" + END,
        b"\x1bx\x1b[120u",
    ],
)
def test_what_is_no_key_is_none(text: bytes) -> None:
    typist = Typist()
    assert typist.type(text) == 0
    assert not typist.wait()


def test_in_a_text_field_the_space_is_a_letter() -> None:
    typist = Typist("ctrl+x")
    assert typist.type(b"a b \x1b[32;;32u") == 0
    assert not typist.wait()
    assert typist.type(CTRL_X) == 1


@pytest.mark.parametrize("begun", [PASTE + b"some words", b"\x1b]0;words", b"\x1b[1", b"\x1bPab"])
def test_nothing_unfinished_swallows_it(begun: bytes) -> None:
    for key in (SPACE, CTRL_X):
        typist = Typist()
        at_once = typist.type(begun + key)
        assert at_once or typist.wait()
        assert typist.type(key) == 1, "the next is without doubt"


@pytest.mark.parametrize("begun", [PASTE, PASTE + b"words", b"\x1b]0;words", b"\x1b["])
@pytest.mark.parametrize("key", [SPACE, CTRL_X, b"\x1b[32u", b"\x1b[120;5u"])
def test_after_a_pause_it_counts_at_once(begun: bytes, key: bytes) -> None:
    typist = Typist()
    typist.type(begun)
    assert not typist.wait(10)
    assert typist.type(key) == 1


def test_a_key_that_is_hammered_in_an_unfinished_paste_is_not_put_off_by_the_next() -> None:
    typist = Typist()
    typist.type(PASTE + b"words")
    assert any(typist.type(CTRL_X) or typist.wait(0.1) for _press in range(4))


def test_a_paste_that_is_slow_may_end_late_without_a_stop() -> None:
    typist = Typist("ctrl+x")
    typist.type(PASTE)
    for _part in range(10):
        assert typist.type(b"a b c ") == 0
        assert not typist.wait(0.9 * UNFINISHED_S)
    assert typist.type(b"d" + END) == 0


def test_another_key_of_the_users_own() -> None:
    typist = Typist("f12")
    assert typist.type(b"a b\x18") == 0
    assert typist.type(b"\x1b[24~") == 1
