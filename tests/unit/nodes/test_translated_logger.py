"""How nodes speak: the language by the environment, one harmless line whatever is said."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.parts.translated_logger import LONGEST, TranslatedLogger, printable
from text.i18n import detect

GREETING = "The sonar publishes {topic}"


class RecordingLogger:
    """Keeps what is logged."""

    def __init__(self) -> None:
        self.lines: list[tuple[str, str]] = []

    def info(self, text: str) -> None:
        self.lines.append(("info", text))

    def warning(self, text: str) -> None:
        self.lines.append(("warning", text))

    def error(self, text: str) -> None:
        self.lines.append(("error", text))


@pytest.mark.parametrize(
    ("environment", "expected"),
    [
        ({}, "en"),
        ({"LANG": "C.UTF-8"}, "en"),
        ({"LANG": "ru_RU.UTF-8"}, "ru"),
        ({"LANG": "ru_RU.UTF-8", "LC_MESSAGES": "en_GB.UTF-8"}, "en"),
        ({"LC_MESSAGES": "en_GB.UTF-8", "LC_ALL": "ru_RU.UTF-8"}, "ru"),
        ({"LC_ALL": "ru_RU.UTF-8", "DECK_LANG": "en"}, "en"),
        ({"LC_ALL": "", "LANG": "ru"}, "ru"),
        ({"LANG": "de_DE.UTF-8", "DECK_LANG": "RU"}, "ru"),
    ],
)
def test_the_first_variable_that_is_set_decides(environment: dict[str, str], expected: str) -> None:
    assert detect(None, environment) == expected


def test_each_severity_goes_its_own_way() -> None:
    logger = RecordingLogger()
    translated = TranslatedLogger(logger, "ru")  # type: ignore[arg-type]
    translated.info(GREETING, topic="a")
    translated.warn(GREETING, topic="b")
    translated.error(GREETING, topic="c")
    words = "Сонар публикует {}"
    levels = zip(("info", "warning", "error"), "abc", strict=True)
    assert logger.lines == [(level, words.format(name)) for level, name in levels]


def test_a_phrase_can_be_held_back_while_others_pass() -> None:
    logger = RecordingLogger()
    translated = TranslatedLogger(logger, "en")  # type: ignore[arg-type]
    other = "Bye"
    for name in "abc":
        translated.info(GREETING, every_s=3600.0, topic=name)
        translated.info(other)
    assert [text for _, text in logger.lines] == ["The sonar publishes a", "Bye", "Bye", "Bye"]


@given(st.text(st.characters()))
def test_whatever_is_said_is_one_line_without_controls(text: str) -> None:
    said = printable(text)
    assert len(said) <= LONGEST
    assert not any(ord(char) < 0x20 or 0x7F <= ord(char) < 0xA0 for char in said)
    said.encode()


def test_control_characters_are_shown_as_pictures() -> None:
    assert printable("a\x1b[31m\x00\n") == "a␛[31m␀␊"


def test_a_fraction_is_written_in_russian_with_a_comma_and_what_one_types_with_a_point() -> None:
    phrase = "{near:.2f}, {topic}, {count}"
    values = {"near": 0.364, "topic": "/sonar.front", "count": 3}
    russian, english = (TranslatedLogger(RecordingLogger(), code) for code in ("ru", "en"))  # type: ignore[arg-type]
    assert russian.text(phrase, **values) == "0,36, /sonar.front, 3"
    assert english.text(phrase, **values) == "0.36, /sonar.front, 3"
