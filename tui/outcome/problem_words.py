"""What is wrong with the LLM's JSON, in the current language."""

from __future__ import annotations

from typing import Any

from robot.commands.problems import Problem
from text.i18n import _, language
from text.plain import plain

LONGEST = 300


def problem_words(problem: Problem) -> str:
    """The place, the field and the fix: `line 3, column 12: commands[1].speed: must be …`."""
    place = _("line {line}, column {column}").format(line=problem.line, column=problem.column)
    parts = [place, problem.field, _message(problem)]
    return plain(": ".join(part for part in parts if part), LONGEST)


def reported_words(report: dict[str, Any]) -> str:
    """The same for a problem reported by llm_parser; accepts any report."""
    args = report.get("args")
    return problem_words(
        Problem(
            field=str(report.get("field", "")),
            line=report.get("line", 1),
            column=report.get("column", 1),
            message=str(report.get("message", "")),
            code=str(report.get("code", "")),
            args=args if isinstance(args, dict) else {},
        )
    )


def _message(problem: Problem) -> str:
    if language() != "ru":
        return problem.message
    try:
        return problem.in_language(language())
    except (KeyError, ValueError, IndexError, TypeError):
        return problem.message
