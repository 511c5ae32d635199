"""A command line of `ros2`, run in this process: what it prints, and its exit code."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass

from ros2.main import main


@dataclass(frozen=True)
class Typed:
    """What came of a command line."""

    code: int
    out: str
    err: str


class _Listened(io.StringIO):
    """Presses Ctrl-C as soon as `until` has been printed so often."""

    def __init__(self, until: str, times: int) -> None:
        super().__init__()
        self._until, self._times = until, times

    def write(self, text: str) -> int:
        written = super().write(text)
        if self._until and self.getvalue().count(self._until) >= self._times:
            self._until = ""
            raise KeyboardInterrupt
        return written


def typed(*words: str, until: str = "", times: int = 1) -> Typed:
    """Run it to its end, or until a text has been printed."""
    out, err = _Listened(until, times), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            code = main(words)
        except SystemExit as ended:
            code = int(str(ended.code))
    return Typed(code, out.getvalue(), err.getvalue())
