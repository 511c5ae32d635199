"""Threads that fail outside of the learner's own lines: the line that has started them."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launcher.faults.failure import Failure


def place_of(failure: Failure, program: str) -> tuple[str, int] | None:
    """Return where a program starts the thread of a failure in which no line is its own."""
    if failure.own is not None or len(failure.levels) < 2:
        return None
    begins = [each for each in failure.levels if not each.file.endswith("/threading.py")]
    if not begins or begins[0] is failure.levels[0]:
        return None
    try:
        tree = ast.parse(Path(program).read_bytes())
    except (OSError, SyntaxError, ValueError):
        return None
    found = [
        each.lineno
        for each in ast.walk(tree)
        if isinstance(each, ast.Call)
        and any(word.arg == "target" and _last_name(word.value) == begins[0].function for word in each.keywords)
    ]
    return (program, min(found)) if found else None


def _last_name(node: ast.AST) -> str:
    return str(getattr(node, "attr", getattr(node, "id", "")))
