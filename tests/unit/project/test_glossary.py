"""One word for one thing: in the Russian of screens, nodes, README and docs alike."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from tests.unit.scripts_of_setup import load

ROOT = Path(__file__).parents[3]
DOCS = (ROOT / "README.ru.md", *sorted((ROOT / "docs").glob("*.ru.md")))
ENGLISH_DOCS = sorted({ROOT / "README.md", *(ROOT / "docs").glob("*.md")} - set(DOCS))
PROFILES = sorted((ROOT / "profiles").glob("*.yaml"))
SPEAKERS = sorted(path for room in ("nodes", "robot") for path in (ROOT / room).rglob("*.py"))
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
    r"\bгейт\w*|\bшлюз\w*": "узел безопасности",
    r"\bотклик\w*": "обратная связь",
    r"\bаккумулятор\w*": "батарея",
    r"\bсустав\w*": "сочленение",
    r"\bнедосоздан\w*": "неполный",
    r"\bвождени\w+|\bводит[ьи]?\b|\bвести (?:стрелк|клавиш)\w+": "управлять",
    r"\bедь\b|\bготово ехать\b": "доехать, готово к движению",
    r"\bпроцессор и память\b": "ЦП и память",
    r"\bне верю\b|\bне верит\b": "не учитывается",
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


@cache
def catalogue() -> tuple[list[str], list[str]]:
    """What the program says in English and in Russian, plural forms one by one."""
    said: list[str] = []
    translated: list[str] = []
    for message in load("catalogues").translated("ru"):
        if message.id:
            said += [message.id] if isinstance(message.id, str) else message.id
            translated += [message.string] if isinstance(message.string, str) else message.string
    return said, translated


@cache
def nodes() -> list[str]:
    """What nodes say, in either language."""
    trees = (ast.parse(path.read_text()) for path in SPEAKERS)
    constants = (
        node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Constant)
    )
    return [constant.value for constant in constants if isinstance(constant.value, str)]


def russian() -> list[str]:
    pages = [CODE.sub("", path.read_text()) for path in (*DOCS, *PROFILES)]
    return catalogue()[1] + nodes() + pages


def english() -> list[str]:
    return catalogue()[0] + [path.read_text() for path in ENGLISH_DOCS]


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
        "нет узла безопасности: перед препятствием робот не остановится",
        "не готов за {seconds:g} с: {why}",
        "никто не публикует {name}",
        "· стр. {page}/{pages} (v — дальше)",
        "Сохранено {size} байт в {path}",
        "имитация",
        "готово к движению",
        "перезапуск",
        "Журнал",
        "ЦП",
    ],
)
def test_what_an_engineer_would_say_is_said(said: str) -> None:
    assert said in russian()
