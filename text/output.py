"""Writing to the standard streams: sanitized text, colour where it is wanted, tables, JSON."""

from __future__ import annotations

import contextlib
import json
import os
import re
import sys
import traceback
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from text.plain import plain, plain_layout, plain_lines, replaced
from text.program import typable

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from types import TracebackType

RED, GREEN, YELLOW, DIM, BOLD = "31", "32", "33", "2", "1"
PREFIX_COLOURS = ("36", "35", "32", "34", "33", "96", "95", "92", "94", "93")
"""Colours for the names of nodes, used in turn."""
_CODE = "|".join(("0", RED, GREEN, YELLOW, DIM, BOLD, *PREFIX_COLOURS))
_COLOUR = re.compile(rf"(\x1b\[(?:{_CODE})(?:;(?:{_CODE}))*m)")


class Paint:
    """Colours for a stream, or none: not a terminal, NO_COLOR, a terminal without colour."""

    def __init__(self, stream: TextIO, environ: Mapping[str, str] | None = None) -> None:
        """Decide once whether colours are wanted."""
        env = os.environ if environ is None else environ
        self.wanted = stream.isatty() and not env.get("NO_COLOR") and env.get("TERM") != "dumb"

    def __call__(self, text: str, *codes: str) -> str:
        """Return the text, which may come from anywhere, in these colours."""
        text = plain(text)
        return f"\x1b[{';'.join(codes)}m{text}\x1b[0m" if self.wanted and codes else text


def harmless(text: str) -> str:
    """Return lines that are safe to write: Deck's own colours are the only control sequences."""
    pieces = _COLOUR.split(text)
    pieces[::2] = map(plain_lines, pieces[::2])
    return "".join(pieces)


def json_text(value: object, indent: int | None = None) -> str:
    """Return JSON in which text stays readable and unsafe characters are escaped."""
    return replaced(json.dumps(value, ensure_ascii=False, indent=indent), _escaped)


def _escaped(character: str) -> str:
    # Line ends occur only between values: inside them they are already escaped.
    return character if character == "\n" else json.dumps(character)[1:-1]


def make_streams_safe() -> None:
    """Make sure that a closed stream, or a character missing in its encoding, raises no error.

    Tracebacks are sanitized as well, because they may contain text from outside.
    """
    sys.excepthook = _tell_fault
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            nowhere = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 - for good
            setattr(sys, name, nowhere)
        elif isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")


def _tell_fault(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    say_error("".join(traceback.format_exception(kind, error, trace)).rstrip("\n"))


def keep_stdout_to_ourselves() -> None:
    """Redirect the output of libraries, above all the complaints of Fast DDS, to standard error.

    A program that reads Deck's JSON would stumble over it.
    """
    ours = os.dup(sys.stdout.fileno())
    with contextlib.suppress(OSError):  # There may be no standard error.
        os.dup2(2, sys.stdout.fileno())
    encoding = sys.stdout.encoding
    sys.stdout = open(ours, "w", encoding=encoding, errors="replace")  # noqa: PTH123, SIM115


def say_error(text: str) -> None:
    """Write to standard error, even if it is closed; commands of Deck's as they can be typed."""
    try:
        sys.stderr.write(harmless(typable(text)) + "\n")
        sys.stderr.flush()
    except (OSError, ValueError):
        pass


def write(text: str) -> None:
    """Write a line to standard output, at once."""
    sys.stdout.write(harmless(text) + "\n")
    sys.stdout.flush()


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return the lines of a table; columns are as wide as necessary, cells may have any text."""
    rows = [[plain(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=False)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=False)).rstrip()
        for row in (head, *rows)
    ]


class HarmlessStream:
    """A text stream on which everything that is written can be shown; line breaks and tabs stay."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write what is left of a text from anywhere; return the length of the text."""
        self._stream.write(plain_layout(text))
        return len(text)

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - as the stream has it
        return getattr(self._stream, name)


@contextlib.contextmanager
def harmless_output() -> Iterator[None]:
    """Have all that is printed in a `with` pass through a `HarmlessStream`."""
    with (
        contextlib.redirect_stdout(HarmlessStream(sys.stdout)),
        contextlib.redirect_stderr(HarmlessStream(sys.stderr)),
    ):
        yield


def drop_output() -> None:
    """Discard further standard output: its reader is gone, which must not cause errors."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
