"""What a lesson says fits the screen it is read on, and says the same in both languages."""

from __future__ import annotations

import re

import pytest

from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LANGUAGES, LessonFolder, folders
from tui.lesson.reading import MOST_PINNED

WIDEST = 76
"""Columns, of the 80 that there are at least."""
WIDEST_CODE = 65
"""The same of what must not be broken, beside the checks at 120 columns, with its indentation."""
LONGEST = 18
"""Lines of a step, of the 24 that there are at least."""
LONGEST_INTRODUCTION = 20
STATEMENT = re.compile(r" {4,}(self\.|[a-z_0-9]+ = |[a-z_0-9]+\.)")
WORDS = re.compile(r'"[^"]*"')
"""What is in quotes may be in the language of the text."""
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


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("lesson", LESSONS, ids=NAMES)
def test_each_step_ends_with_a_task_that_stays_in_sight(
    lesson: LessonFolder, language: str
) -> None:
    texts = lesson.texts(language)
    tasks = {step.id: texts.task(step.id) for step in lesson.steps}
    begins = {"en": "**Your task**: ", "ru": "**Задание**: "}[language]
    assert [name for name, task in tasks.items() if not task.startswith(begins)] == []
    assert [name for name, task in tasks.items() if len(task.splitlines()) > MOST_PINNED] == []


@pytest.mark.parametrize("lesson", LESSONS, ids=NAMES)
def test_the_languages_show_the_same_code(lesson: LessonFolder) -> None:
    english, russian = (_code(lesson, language) for language in ("en", "ru"))
    assert english == russian


def _code(lesson: LessonFolder, language: str) -> dict[str, list[str]]:
    """Return the statements in a text, by section."""
    return {
        name: [WORDS.sub('""', line) for line in text.splitlines() if STATEMENT.match(line)]
        for name, text in lesson.texts(language).sections.items()
    }
