"""What `make test` needs is what the README installs; the rest is left to `make test-all`."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from tests.machine import MARK, NEEDS, left_out

TESTS = Path(__file__).resolve().parents[2]
MORE = re.compile(
    r"^from tests\.(?:namespaces|own_numbers|browser) import"
    r'|"(?:unshare|nsenter)",|subprocess\.\w+\(\s*\["(?:ip|ps)"',
    re.MULTILINE,
)


def test_whoever_asks_more_of_a_machine_says_so() -> None:
    asking = {path: path.read_text(encoding="utf-8") for path in TESTS.rglob("test_*.py")}
    silent = [
        path.name
        for path, text in asking.items()
        if MORE.search(text) and f"mark.{MARK}(" not in text
    ]
    assert silent == []


def test_what_is_missing_is_named_before_anything_starts(tmp_path: Path) -> None:
    """On a machine without a single program."""
    told = subprocess.run(
        [sys.executable, "-m", "tests.machine"],
        env={**os.environ, "PATH": str(tmp_path)},
        cwd=TESTS.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    assert told.returncode == 1
    lines = told.stderr.splitlines()
    assert len(lines) == len(NEEDS)
    assert "Chromium (apt install chromium)" in lines[0]


def test_it_is_said_what_was_left_out() -> None:
    assert left_out([]) == ""
    assert left_out([("browser",), ("ip", "namespaces"), ("browser",)]) == (
        "left out, since they need more than the README's line: 3 (2 browser, 1 ip+namespaces);"
        " make test-all runs them"
    )
