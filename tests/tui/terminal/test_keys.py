"""What the terminal sends as keys, and the emergency stop among it, whatever else has come."""

from __future__ import annotations

import random
import string

import pytest
from textual.events import Key
from textual.message import Message

from tui.terminal.alt_keys import ESC, AltKeyParser
from tui.terminal.stop_scan import UNFINISHED_S, StopScan


def names(found: list[Message]) -> list[str]:
    return [one.key if isinstance(one, Key) else type(one).__name__ for one in found]


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("\x1bv\x1bv\x1bv", ["alt+v"] * 3),
        ("\x1bv\x1b[A", ["alt+v", "up"]),
        ("\x1b[A\x1bvq", ["up", "alt+v", "q"]),
        ("\x1bv\x1b[<35;10;10M", ["alt+v", "MouseMove"]),
        ("\x1bм\x1bм", ["alt+м", "alt+м"]),
        ("\x1bW\x1bW", ["alt+shift+w"] * 2),
        ("\x1bOP\x1b[15~", ["f1", "f5"]),
        ("\x1b\x7f\x1bf", ["ctrl+w", "ctrl+right"]),
        ("\x1bv\x1b[200~va\x1b[201~v", ["alt+v", "Paste", "v"]),
    ],
)
def test_what_follows_does_not_change_it(typed: str, expected: list[str]) -> None:
    assert names(list(AltKeyParser().feed(typed))) == expected


def test_escape_alone_is_escape_and_a_bare_letter_is_none_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    parser = AltKeyParser()
    assert names(list(parser.feed("\x1b"))) == []
    monkeypatch.setattr("textual._parser.get_time", lambda: float("inf"))
    assert names(list(parser.tick())) == ["escape"]
    assert names(list(parser.feed("v"))) == ["v"]


@pytest.mark.parametrize(
    ("typed", "key"),
    [
        # Ctrl+X on a Russian, Ukrainian, Greek and Hebrew keyboard, with and without its place.
        ("\x1b[1095;5u", "ctrl+x"),
        ("\x1b[1095::120;5u", "ctrl+x"),
        ("\x1b[1110;5u", "ctrl+s"),
        ("\x1b[967;5u", "ctrl+x"),
        ("\x1b[1505;5u", "ctrl+x"),
        ("\x1b[1505::120;5u", "ctrl+x"),
        ("\x1b[1084;3u", "alt+v"),
        # On a Dvorak keyboard the letter that it types is the key.
        ("\x1b[120::98;5u", "ctrl+x"),
        ("\x1b[1095::120;;1095u", "ч"),
        ("\x1b[1063;2;1063u", "Ч"),
        ("\x1b[0;;1095u", "ч"),
        ("\x1b[97:65;2;65u", "A"),
        ("\x1b[97;5:1u", "ctrl+a"),
        ("\x1b[97;5:2u", "ctrl+a"),
        ("\x1b[1;1:1A", "up"),
        ("\x1b[57417;1u", "left"),
        ("\x1b[13u", "enter"),
        ("\x1b[3;5~", "ctrl+delete"),
    ],
)
def test_a_key_is_read_in_every_form_of_the_kitty_protocol(typed: str, key: str) -> None:
    assert names(list(AltKeyParser().feed(typed + "\x18"))) == [key, "ctrl+x"]


@pytest.mark.parametrize(
    "typed",
    [
        "\x1b[97;5:3u", "\x1b[1114112u", "\x1b[99999999999u", "\x1b[97;;1114112u",
        "\x1b[55296u", "\x1b[97;999999u", "\x1b[1095::1114112;5u", "\x1b[-1u", "\x1b[?1u",
        "\x1b[?25u", "\x1b[=5;2z", "\x1b[48;0;0;0;0t\x1b[<0;1;1M",
    ],
)  # fmt: skip
def test_what_is_no_key_is_left_out_and_the_next_key_is_one(typed: str) -> None:
    keys = [one.key for one in AltKeyParser().feed(typed + "\x18x") if isinstance(one, Key)]
    assert keys == ["ctrl+x", "x"]


def scraps(dice: random.Random) -> str:
    parts = (ESC, f"{ESC}[", f"{ESC}O", *"u~AM;:?<Rt", "200~", "$y")
    numbers = (0, 1, 3, 5, 97, 1095, 55296, 1114111, 1114112, 10**12)
    return "".join(
        dice.choice(
            [
                dice.choice(parts),
                str(dice.choice(numbers)),
                dice.choice(string.printable),
                chr(dice.randrange(0x3000)),
            ]
        )
        for _ in range(dice.randrange(1, 12))
    )


MANY = pytest.param(1_000_000, marks=[pytest.mark.nightly, pytest.mark.timeout(900)])


@pytest.mark.parametrize("count", [20_000, MANY])
def test_behind_whatever_comes_the_stop_key_stops(count: int) -> None:
    """It is found among the bytes, and no key after a pause is swallowed by the parser."""
    dice = random.Random(count)
    time_s = 0.0
    scan = StopScan(lambda key: key == "ctrl+x", lambda: time_s)
    parser = AltKeyParser()
    for number in range(count):
        scrap = scraps(dice)
        for _piece in scan.cut(scrap.encode()):
            pass
        list(parser.feed(scrap))
        # At once, or soon after it if what it is inside of does not end; after a pause at once.
        time_s += number % 2
        at_once = any(stops for _piece, stops in scan.cut(b"\x18"))
        time_s += 1.0
        assert at_once or (scan.overdue() and not number % 2), (number, scrap)
        scan.end_paste()
        if number % 50 == 0:
            list(parser.feed("\x1b[201~"))
            parser._timeout_time = 0.0
            list(parser.tick())
            assert "ctrl+x" in names(list(parser.feed("\x18"))), (number, scrap)


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
        SPACE, CTRL_X, b"\x1b[32u", b"\x1b[32;1u", b"\x1b[32;;32u", b"\x1b[120;5u", b"\x1bO ",
        b"\x1b ", b"\x1b\x1b ", b"\x1b\x18", b"\x1b[\x18", b"\x1b[1;\x18", b"\x1bO\x18",
        b"\x1b]0;title\x18", b"\x1bP1$r\x18",
    ],
)  # fmt: skip
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
