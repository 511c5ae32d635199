"""One word for one thing: in the Russian of the screen, of the README and of the docs alike."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from babel.messages.pofile import read_po

ROOT = Path(__file__).parents[2]
CATALOGUE = ROOT / "tui" / "locale" / "ru" / "LC_MESSAGES" / "deck.po"
DOCS = (ROOT / "README.ru.md", *sorted((ROOT / "docs").glob("*.ru.md")))
PROFILES = sorted((ROOT / "profiles").glob("*.yaml"))
CODE = re.compile(r"```.*?```|`[^`]*`", re.DOTALL)
INSTEAD = {
    r"\bлог(и|а|ов|у|е|ах|ом|ами)?\b": "журнал",
    r"\bмок(и|а|ов|ам|ами)?\b|\bзаглушк\w+": "имитация",
    r"\bрестарт\w*": "перезапуск",
    r"(?<!/)\bCPU\b": "ЦП",
    r"\bнод[аыуе]\w*": "узел",
    r"\bтаймаут\w*": "время ожидания",
    r"\bэкстренн\w+|\bаварийн\w+ остан\w+": "аварийный стоп",
    r"\bм/сек\b|\bсек\.": "м/с, с",
    r"\bсообщени\w* действи\w+|состояни\w* действи\w+": "экшен",
}
"""What is not said, and what is said instead."""
IN_ENGLISH = (
    r"(?<!there )\bis no (?!longer\b|more\b|port\b|reading\b)",
    r"\bhalf[ -]made\b",
    r"\bonce more for\b",
    r"\bwants blanks\b",
    r"\banew\b",
    r"\bone sees\b",
)
"""What no native speaker would write."""


def russian() -> list[str]:
    with CATALOGUE.open("rb") as file:
        found = [message.string for message in read_po(file) if message.id]
    sentences = [text for one in found for text in ([one] if isinstance(one, str) else one)]
    return sentences + [CODE.sub("", path.read_text()) for path in (*DOCS, *PROFILES)]


def english() -> list[str]:
    with CATALOGUE.open("rb") as file:
        found = [message.id for message in read_po(file) if message.id]
    sentences = [text for one in found for text in ([one] if isinstance(one, str) else one)]
    paths = (ROOT / "README.md", *(ROOT / "docs").glob("*[!u].md"))
    return sentences + [path.read_text() for path in paths if not path.name.endswith(".ru.md")]


@pytest.mark.parametrize("pattern", INSTEAD)
def test_a_thing_has_one_russian_name(pattern: str) -> None:
    said = [match[0] for text in russian() for match in re.finditer(pattern, text, re.IGNORECASE)]
    assert said == [], f"say: {INSTEAD[pattern]}"


@pytest.mark.parametrize("pattern", IN_ENGLISH)
def test_english_is_as_a_native_speaker_writes_it(pattern: str) -> None:
    assert [text for text in english() if re.search(pattern, text, re.IGNORECASE)] == []


@pytest.mark.parametrize(
    "said",
    [
        "Нет узла безопасности: перед препятствием робот не остановится",
        "не готов за {seconds:g} с: {why}",
        "никто не публикует {name}",
        "· стр. {page}/{pages} (v — дальше)",
        "Сохранено {size} байт в {path}",
        "имитация",
        "перезапуск",
        "Журнал",
        "ЦП",
    ],
)
def test_what_an_engineer_would_say_is_said(said: str) -> None:
    assert said in russian()
