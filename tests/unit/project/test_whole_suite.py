"""A machine where some test cannot run is one where the project is not tested."""

from __future__ import annotations

import re
from pathlib import Path

TESTS = Path(__file__).resolve().parents[2]
LEFT_OUT = re.compile(r"\b(pytest\.(skip|xfail|importorskip)|mark\.(skip|skipif|xfail))\b")


def test_no_test_is_left_out_on_any_machine() -> None:
    sources = {path: path.read_text(encoding="utf-8") for path in TESTS.rglob("*.py")}
    assert [path.name for path, text in sources.items() if LEFT_OUT.search(text)] == []
