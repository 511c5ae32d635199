"""Where the task of a step begins in its text."""

from __future__ import annotations

from pathlib import Path

import pytest

from course.lessons.lesson import LessonFolder


@pytest.mark.parametrize(
    ("text", "explained", "task"),
    [
        ("why\n\n**Your task**: do it\n\n    code\n", "why", "**Your task**: do it\n\n    code"),
        ("why\n\n**Задание**: сделать\n", "why", "**Задание**: сделать"),
        ("why\n\nmore\n\ndo it\n", "why\n\nmore", "do it"),
        ("do it\n", "", "do it"),
        ("    code\n\n**Your task**: do it\n", "    code", "**Your task**: do it"),
        ("why\n\n```\none\n\ntwo\n```\n", "why\n\n```\none\n\ntwo\n```", ""),
    ],
)
def test_a_task_is_told_apart_from_what_a_step_explains(
    tmp_path: Path, text: str, explained: str, task: str
) -> None:
    (tmp_path / "text.en.md").write_text(f"# Title\n\nabout\n\n## one\n\n{text}", "utf-8")
    texts = LessonFolder(tmp_path).texts("en")
    assert (texts.explained("one"), texts.task("one")) == (explained, task)
    assert texts.task("another") == ""
