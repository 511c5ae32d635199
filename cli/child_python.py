"""Small programs for another Python process, which may hang or crash as this one must not."""

from __future__ import annotations

import sys

_NOT_FROM_HERE = "import sys; sys.path[:] = [place for place in sys.path if place]\n"
"""`-c` would look for modules in the current folder first, whatever lies there."""


def python(program: str, *arguments: str) -> list[str]:
    """Return the command line that runs a program with this Python."""
    return [sys.executable, "-c", _NOT_FROM_HERE + program, *arguments]
