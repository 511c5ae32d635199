"""Text from anywhere made harmless, and sentences that can be translated."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from launcher.errors import SessionError
from text.i18n import localized, set_language
from text.plain import is_plain, plain, plain_lines
from text.sentences import reason_of, say

HOSTILE = {
    "clipboard": ("\x1b]52;c;aGk=\x07", "␛]52;c;aGk=␇"),
    "reset": ("\x1bc", "␛c"),
    "colour": ("\x1b[31mred", "␛[31mred"),
    "NUL, DEL and a line's end": ("a\0b\x7fc\r\n\td", "a␀b␡c␍␊␉d"),
    "C1": ("\x9b31m\x90q\x9d0;t\x9c\x85", "�31m�q�0;t��"),
    "turned round": ("abc\u202edcba\u202c", "abc�dcba�"),
    "isolated": ("\u2066a\u2067b\u2068c\u2069", "�a�b�c�"),
    "marks of direction": ("a\u200e\u200f\u061cb", "a���b"),
    "no room": ("/dri\u200bve\u2060\ufeff\u00ad", "/dri�ve���"),
    "joiners in Latin": ("ad\u200dmin\u200c", "ad�min�"),
    "joiners one after another": ("👩\u200d\u200d👩", "👩��👩"),
    "tags that spell a message": ("x\U000e0068\U000e0069", "x��"),
    "tags without their end": ("\U0001f3f4\U000e0067\U000e0062x", "\U0001f3f4��x"),
    "selectors that carry bytes": ("a\ufe01\ufe0f\U000e0101", "a���"),
    "selectors after an emoji": ("❤\ufe0f\ufe0f\ufe0f", "❤\ufe0f��"),
    "fillers": ("a\u3164\u115f\uffa0b", "a���b"),
    "lines and paragraphs": ("a\u2028b\u2029c", "a�b�c"),
    "half characters": ("\ud800a\udfff", "�a�"),
    "private use, and none at all": ("\ue000\U000f0000\ufdd0\uffff\U0001fffe", "�����"),
}

GENUINE = [
    "Привет, мир: ёж № 5 — «всё»",
    "it's 21 °C, naïve café, 5 × 3 µm",
    "שלום עולם",
    "مرحبا بالعالم",
    "می\u200cخواهم",
    "क्\u200dष और श्री\u200cमान्",
    "ශ්\u200dරී ලංකා",
    "你好，世界 こんにちは 안녕하세요",
    "葛\U000e0100城",
    "👨\u200d👩\u200d👧\u200d👦 ❤\ufe0f\u200d🔥 👍🏽 🕵🏻\u200d♂\ufe0f ☁\ufe0e 1\ufe0f\u20e3",
    "🇷🇺 🏴\U000e0067\U000e0062\U000e0073\U000e0063\U000e0074\U000e007f",
    "[red]markup[/red] [/] \\[",
    "50\u00a0% ▁▂▃ ●◔○ ⚠ ✗",
]

_SINGLE = "ab1#Яم一क्👩❤♂🏽🏴\u200d\u200c\ufe0f\ufe0e\U000e0067\U000e007f\U000e0100\u180b\x1b\n"
_PARTS = st.sampled_from([*(text for text, _shown in HOSTILE.values()), *GENUINE, *_SINGLE])
TEXTS = st.one_of(st.text(max_size=60), st.lists(_PARTS, max_size=12).map("".join))
"""Any text whatever, and texts made of what is known to be delicate."""

JOINERS = "\u200c\u200d"


@pytest.mark.parametrize(("text", "shown"), HOSTILE.values(), ids=HOSTILE)
def test_what_is_hidden_or_obeyed_is_made_visible(text: str, shown: str) -> None:
    assert plain(text) == shown
    assert not is_plain(text)


@pytest.mark.parametrize("text", GENUINE)
def test_what_people_write_stays_as_it_is(text: str) -> None:
    assert plain(text) == text
    assert is_plain(text)


@given(TEXTS)
@example("a\ufe0f\u200d😀")
def test_nothing_is_left_that_a_terminal_obeys_or_a_reader_does_not_see(text: str) -> None:
    shown = plain(text)
    assert len(shown) == len(text)
    assert plain(shown) == shown
    categories = {unicodedata.category(one) for one in shown}
    assert not categories & {"Cc", "Cs", "Co", "Zl", "Zp"}
    for at, one in enumerate(shown):
        assert one not in "\u034f\u061c\u200b\u200e\u200f\u2060\u3164\uffa0\ufeff"
        assert not "\u202a" <= one <= "\u202e"
        assert not "\u2061" <= one <= "\u206f"
        if one in JOINERS or "\ufe00" <= one <= "\ufe0f":
            assert at > 0, "it has nothing to join, or to vary"
            assert shown[at - 1] not in f"{JOINERS}\n ", "it hides behind another, or in a blank"
            assert not ("a" <= shown[at - 1].lower() <= "z")


@given(st.text(st.characters(codec="koi8-r", exclude_categories=["Cc"]), max_size=200))
def test_russian_and_english_come_through_unchanged(text: str) -> None:
    assert plain(text) == text


@given(TEXTS)
def test_lines_are_kept_where_there_are_lines(text: str) -> None:
    assert plain_lines(text).split("\n") == [plain(line) for line in text.split("\n")]


def test_no_more_is_looked_at_than_is_shown() -> None:
    assert plain("abc\x1bd", 4) == "abc␛"


SENTENCE = say("ROS cannot be used: {error}", error="no rclpy")


def test_the_sentence_of_an_error_can_still_be_translated() -> None:
    error = SessionError(SENTENCE)
    assert reason_of(error) == str(error)
    assert localized(reason_of(error), "ru") == "ROS не работает: no rclpy"
    assert localized(str(error), "ru") == str(error)


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (ValueError("not a number"), "not a number"),
        (OSError(5, "Input/output error"), "[Errno 5] Input/output error"),
        (TimeoutError(), "TimeoutError"),
        (RuntimeError(SENTENCE, 7), str(RuntimeError(str(SENTENCE), 7))),
    ],
)
def test_an_error_without_a_sentence_says_its_text_or_its_kind(error: Exception, words: str) -> None:
    assert reason_of(error) == words


@pytest.fixture
def in_russian() -> Iterator[None]:
    set_language("ru")
    yield
    set_language("en")


@pytest.mark.usefixtures("in_russian")
def test_a_number_has_a_comma_and_a_text_keeps_its_point() -> None:
    words = say("{a:.2f}, {b}, {c}", a=0.5, b="1.2.0", c=3)
    assert localized(words) == localized(words, "ru") == "0,50, 1.2.0, 3"
    assert localized(words, "en") == "0.50, 1.2.0, 3"
