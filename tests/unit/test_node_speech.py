"""How nodes speak: the language by the environment, one harmless line whatever is said."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.parts.speech import LONGEST, Phrase, Speech, language, printable

GREETING = Phrase("Hello {name}", "Привет {name}")


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
    assert language(environment) == expected


def test_each_severity_goes_its_own_way() -> None:
    logger = RecordingLogger()
    speech = Speech(logger, "ru")  # type: ignore[arg-type]
    speech.info(GREETING, name="a")
    speech.warn(GREETING, name="b")
    speech.error(GREETING, name="c")
    assert logger.lines == [("info", "Привет a"), ("warning", "Привет b"), ("error", "Привет c")]


def test_a_phrase_can_be_held_back_while_others_pass() -> None:
    logger = RecordingLogger()
    speech = Speech(logger, "en")  # type: ignore[arg-type]
    other = Phrase("Bye", "Пока")
    for name in "abc":
        speech.info(GREETING, every_s=3600.0, name=name)
        speech.info(other)
    assert [text for _, text in logger.lines] == ["Hello a", "Bye", "Bye", "Bye"]


@given(st.text(st.characters()))
def test_whatever_is_said_is_one_line_without_controls(text: str) -> None:
    said = printable(text)
    assert len(said) <= LONGEST
    assert not any(ord(char) < 0x20 or 0x7F <= ord(char) < 0xA0 for char in said)
    said.encode()


def test_control_characters_are_shown_as_pictures() -> None:
    assert printable("a\x1b[31m\x00\n") == "a␛[31m␀␊"


def test_a_fraction_is_written_in_russian_with_a_comma_and_what_one_types_with_a_point() -> None:
    phrase = Phrase("{near:.2f} m of {topic}, {count}", "{near:.2f} м от {topic}, {count}")
    values = {"near": 0.364, "topic": "/sonar.front", "count": 3}
    russian, english = (Speech(RecordingLogger(), code) for code in ("ru", "en"))  # type: ignore[arg-type]
    assert russian.text(phrase, **values) == "0,36 м от /sonar.front, 3"
    assert english.text(phrase, **values) == "0.36 m of /sonar.front, 3"
