"""What beginners get wrong is written as changes of a solution, which must fit it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder, folders, read_mistakes
from course.proof.skeleton import new_lesson
from launcher.errors import UsageError


def _make(lines: list[str], folder: Path) -> None:
    for mistake in read_mistakes(Path("wrong.diff"), lines):
        mistake.make(folder)


def _made(lesson: LessonFolder, place: Path) -> None:
    """Make each mistake in a copy of the solution."""
    for number, mistake in enumerate(lesson.mistakes()):
        copy = place / str(number)
        shutil.copytree(lesson.solution, copy)
        mistake.make(copy)
        for file in {each.file for each in mistake.places}:
            text = (copy / file).read_text("utf-8")
            assert text != (lesson.solution / file).read_text("utf-8")
            compile(text, file, "exec")


@pytest.mark.parametrize("name", [folder.name for folder in folders(SHIPPED)])
def test_each_mistake_fits_its_solution(name: str, tmp_path: Path) -> None:
    _made(LessonFolder(SHIPPED / name), tmp_path)


def test_those_of_a_new_lesson_fit_too(tmp_path: Path) -> None:
    lesson = LessonFolder(new_lesson(tmp_path / "mine"))
    assert [(one.step, one.name) for one in lesson.mistakes()] == [
        ("topic", "another-name"),
        ("rate", "once-in-two-seconds"),
    ]
    _made(lesson, tmp_path)


def test_what_diff_writes_can_be_put_in(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("one\ntwo\n\nthree\nfour\n")
    text = """\
## s/m
--- a.py	2026-11-29
+++ b.py
@@ -1,2 +1,2 @@
 one
-two
+2

@@ -4,2 +4,1 @@
 three
-four
"""
    _make(text.splitlines(), tmp_path)
    assert (tmp_path / "a.py").read_text() == "one\n2\n\nthree\n"


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["## s/m", "--- a.py", "-three"], "a.py has these lines 0 times, not once; add lines that stay: three"),
        (["## s/m", "--- a.py", "-one"], "a.py has these lines 2 times"),
        (["## s/m", "--- b.py", "-one"], "b.py has these lines 0 times"),
        (["## s/m", "--- a.py", "one"], "wrong.diff:3: expected ## STEP/MISTAKE"),
        (["## s/m", "-one"], "wrong.diff:2: expected"),
    ],
)
def test_what_does_not_fit_is_told(lines: list[str], words: str, tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("one\ntwo\none\n")
    with pytest.raises(UsageError, match=f"^{words}"):
        _make(lines, tmp_path)
