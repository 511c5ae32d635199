"""A message as the lines of a folding tree: what is folded, what is cut, how much is left out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from text.i18n import _, ngettext
from text.plain import plain
from tui.echo import values as echo_values

if TYPE_CHECKING:
    from graph.data import Value

Path: TypeAlias = "tuple[str | int, ...]"
IsOpen: TypeAlias = "Callable[[Path, bool], bool]"
"""Whether the branch at this path is open, given whether it is open by default."""

MAX_LINES = 2000
OPENED_ITEMS = 200
"""Items of an array, or lines of a text or of bytes, that an open branch shows."""
CHUNK = 64
"""Characters in a line of a long text."""
HEX_CHUNK = 16
DEEPEST_OPEN = 5
HEADER = "header"
"""Folded by default: stamp and frame are seldom of interest, and take four lines."""
WIDEST_KEY = 24


@dataclass(frozen=True)
class EchoLine:
    """One line of the tree."""

    path: Path
    label: str
    """Field name or index with its colon, padded to its neighbours; empty in a continuation."""
    text: str
    kind: str
    """How it is drawn: `branch`, `number`, `text`, `bytes` or `note`."""
    open: bool | None = None
    """None if it cannot be folded."""

    @property
    def depth(self) -> int:
        return len(self.path) - 1


def echo_lines(message: Mapping[str, Value], is_open: IsOpen) -> list[EchoLine]:
    """Return the lines of a message, at most `MAX_LINES` of them."""
    if not message:
        return [EchoLine(("",), "", _("(a message without fields)"), "note")]
    lines = list(islice(_children((), message, is_open), MAX_LINES + 1))
    if len(lines) > MAX_LINES:
        lines[MAX_LINES:] = [EchoLine(("",), "", "…", "note")]
    return lines


def _children(path: Path, message: Mapping[str, Value], is_open: IsOpen) -> Iterator[EchoLine]:
    widest = min(WIDEST_KEY, max(map(len, message), default=0)) + 1
    places = echo_values.places(message.values())
    for key, value in message.items():
        yield from _value((*path, key), f"{plain(key)}:".ljust(widest), value, places, is_open)


def _value(path: Path, label: str, value: Value, places: int, is_open: IsOpen) -> Iterator[EchoLine]:
    if echo_values.is_branch(value):
        yield from _branch(path, label.rstrip(), value, is_open)
        return
    if echo_values.is_number(value):
        yield EchoLine(path, label, echo_values.aligned(value, places), "number")
        return
    below = _contents(path, value, is_open)
    foldable = next(below, None)
    opened = is_open(path, False) if foldable else None
    kind = "text" if isinstance(value, str) else "bytes" if isinstance(value, bytes) else "number"
    yield EchoLine(path, label, echo_values.scalar(value), kind, opened)
    if opened and foldable:
        yield foldable
        yield from below


def _branch(path: Path, label: str, value: Value, is_open: IsOpen) -> Iterator[EchoLine]:
    opened = is_open(path, len(path) <= DEEPEST_OPEN and path[-1] != HEADER)
    if isinstance(value, Mapping):
        fields = ngettext("{n} field", "{n} fields", len(value)).format(n=len(value))
        yield EchoLine(path, label, "" if opened and value else f"({fields})", "branch", opened)
        if opened:
            yield from _children(path, value, is_open)
    elif isinstance(value, Sequence):
        counted = f"({echo_values.items(len(value))})"
        yield EchoLine(path, label, counted, "branch", opened)
        if opened:
            yield from _numbered(path, value, is_open)


def _contents(path: Path, value: Value, is_open: IsOpen) -> Iterator[EchoLine]:
    """Return the contents of a leaf that can be opened; nothing if its own line shows all of it."""
    if isinstance(value, str):
        if len(value) > CHUNK:
            yield from _chunks(path, value)
    elif isinstance(value, bytes):
        if len(value) > HEX_CHUNK:
            yield from _hex_dump(path, value)
    elif isinstance(value, (np.ndarray, Sequence)):
        yield from _numbered(path, value, is_open)


def _numbered(
    path: Path, values: Sequence[Value] | np.ndarray[tuple[int, ...], np.dtype[np.generic]], is_open: IsOpen
) -> Iterator[EchoLine]:
    shown = min(len(values), OPENED_ITEMS)
    widest = len(f"[{shown - 1}]:")
    places = echo_values.places(values[:shown])
    for index in range(shown):
        label = f"[{index}]:".ljust(widest)
        yield from _value((*path, index), label, values[index], places, is_open)
    rest = len(values) - shown
    if rest:
        text = ngettext("… {n} more item", "… {n} more items", rest).format(n=rest)
        yield EchoLine((*path, shown), "", text, "note")


def _chunks(path: Path, value: str) -> Iterator[EchoLine]:
    shown = min(len(value), CHUNK * OPENED_ITEMS)
    for start in range(0, shown, CHUNK):
        yield EchoLine((*path, start), "", plain(value[start : start + CHUNK]), "text")
    rest = len(value) - shown
    if rest:
        text = ngettext("… {n} more character", "… {n} more characters", rest).format(n=rest)
        yield EchoLine((*path, shown), "", text, "note")


def _hex_dump(path: Path, value: bytes) -> Iterator[EchoLine]:
    shown = min(len(value), HEX_CHUNK * OPENED_ITEMS)
    for start in range(0, shown, HEX_CHUNK):
        row = value[start : start + HEX_CHUNK]
        text = f"{start:06x}  {row.hex(' '):{3 * HEX_CHUNK}} {echo_values.printable(row)}"
        yield EchoLine((*path, start), "", text, "bytes")
    rest = len(value) - shown
    if rest:
        text = ngettext("… {n} more byte", "… {n} more bytes", rest).format(n=rest)
        yield EchoLine((*path, shown), "", text, "note")
