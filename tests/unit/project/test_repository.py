"""What the repository promises: no circles, one word for one thing, what fits and is locked."""

from __future__ import annotations

import re
from functools import cache
from graphlib import CycleError, TopologicalSorter
from string import Formatter
from typing import cast

import grimp
import pytest
from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LANGUAGES, LessonFolder, folders
from tests.rooms import ROOMS
from tests.unit.scripts_of_setup import ROOT, load


def test_no_module_needs_itself_by_way_of_others() -> None:
    """Imports for type checkers, and those within functions, count as well.

    But for one: a screen binds its actions, which name it as the type of what they act on.
    """
    graph = grimp.build_graph(*ROOMS, cache_dir=None)
    needs = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    run_time = grimp.build_graph("tui", exclude_type_checking_imports=True, cache_dir=None)
    for module in run_time.modules:
        if ".actions" in module:
            needs[module] &= run_time.find_modules_directly_imported_by(module) | (needs[module] - run_time.modules)
    try:
        TopologicalSorter(needs).prepare()
    except CycleError as error:
        circle: list[str] = error.args[1]
    else:
        circle = []
    assert circle == []


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


@cache
def catalogue() -> list[tuple[str, str]]:
    """What the program says in English and in Russian, plural forms one by one."""
    said: list[tuple[str, str]] = []
    for message in load("catalogues").translated("ru"):
        if message.id and isinstance(message.id, str):
            said.append((message.id, str(message.string)))
        elif message.id:
            said += [(message.id[1], string) for string in message.string]
    return said


@pytest.mark.parametrize("pattern", INSTEAD)
def test_a_thing_has_one_russian_name(pattern: str) -> None:
    said = [russian for _english, russian in catalogue() if re.search(pattern, russian, re.IGNORECASE)]
    assert said == [], f"say: {INSTEAD[pattern]}"


def placeholders(text: str) -> set[str | None]:
    return {name for _text, name, _spec, _conversion in Formatter().parse(text)} - {None}


def test_each_placeholder_of_the_english_is_in_the_russian_and_no_other() -> None:
    assert len(catalogue()) > 1000
    differing = [
        (english, russian)
        for english, russian in catalogue()
        if "{" in english and placeholders(english) != placeholders(russian)
    ]
    assert differing == []


WIDEST = 76
"""Columns, of the 80 that there are at least."""
WIDEST_CODE = 65
"""The same of what must not be broken, beside the checks at 120 columns, with its indentation."""
LONGEST = 18
"""Lines of a step, of the 24 that there are at least."""
LONGEST_INTRODUCTION = 20
LESSONS = [LessonFolder(folder) for folder in folders(SHIPPED)]
NAMES = [lesson.name for lesson in LESSONS]


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("lesson", LESSONS, ids=NAMES)
def test_a_text_fits_a_screen_of_80_by_24(lesson: LessonFolder, language: str) -> None:
    lines = (lesson.path / f"text.{language}.md").read_text("utf-8").splitlines()
    assert [line for line in lines if len(line) > WIDEST] == []
    code = [line for line in lines if line.startswith("    ")]
    assert [line for line in code if len(line) > WIDEST_CODE] == []
    texts = lesson.texts(language)
    assert len(texts.introduction.splitlines()) <= LONGEST_INTRODUCTION
    long = {name for name, text in texts.sections.items() if len(text.splitlines()) > LONGEST}
    assert long == set()


@pytest.mark.parametrize("lesson", LESSONS, ids=NAMES)
def test_the_languages_have_the_same_steps_each_with_a_task(lesson: LessonFolder) -> None:
    english, russian = (lesson.texts(language).sections for language in ("en", "ru"))
    assert [*english] == [*russian] == [step.id for step in lesson.steps]


lock = load("lock")
PYTHONS = ["3.10", "3.11", "3.12", "3.13"]
LOCKED = ["deck", "docs", "interfaces-jazzy", "interfaces-kilted", "ros-jazzy", "ros-kilted", "view"]


def machine(python: str) -> dict[str, str]:
    return {
        **cast("dict[str, str]", default_environment()),
        "python_version": python,
        "python_full_version": f"{python}.4",
        "sys_platform": "linux",
        "platform_machine": "x86_64",
    }


def entries(name: str) -> list[tuple[Requirement, list[str]]]:
    text = (ROOT / "locked" / f"{name}.txt").read_text().replace("\\\n", " ")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return [(Requirement(line.partition(" --hash")[0].strip()), re.findall(r"--hash=(\S+)", line)) for line in lines]


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("name", LOCKED)
def test_what_is_asked_for_is_locked_once_for_every_python(name: str, python: str) -> None:
    here = machine(python)
    locked: dict[str, list[Requirement]] = {}
    # What both need is in the one that is installed first.
    files = [name] if name == "deck" or name.startswith("interfaces") else ["deck", name]
    for requirement, _hashes in (entry for file in files for entry in entries(file)):
        if requirement.marker is None or requirement.marker.evaluate(here):
            locked.setdefault(canonicalize_name(requirement.name), []).append(requirement)
    assert all(len(versions) == 1 for versions in locked.values())
    for line in asked_for()[name]:
        wanted = Requirement(line)
        if wanted.marker is not None and not wanted.marker.evaluate(here):
            continue
        (found,) = locked[canonicalize_name(wanted.name)]
        (version,) = found.specifier
        assert wanted.specifier.contains(version.version, prereleases=True), line


def asked_for() -> dict[str, list[str]]:
    asked: dict[str, list[str]] = lock.requirements()
    return asked
