"""Small programs to run in another Python process, since they may hang or crash."""

from __future__ import annotations

import sys

_NOT_FROM_HERE = "import sys; sys.path[:] = [place for place in sys.path if place]\n"
"""`-c` would search the current folder for modules first, whatever is in it."""


def python(program: str, *arguments: str) -> list[str]:
    return [sys.executable, "-c", _NOT_FROM_HERE + program, *arguments]
