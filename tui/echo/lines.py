"""A message as the lines of a folding tree: what is folded, what is cut, how much is left out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, TypeAlias, TypeGuard

import numpy as np

from text.i18n import _, ngettext
from text.plain import plain

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
    if not message:
        return [EchoLine(("",), "", _("(a message without fields)"), "note")]
    lines = list(islice(_children((), message, is_open), MAX_LINES + 1))
    if len(lines) > MAX_LINES:
        lines[MAX_LINES:] = [EchoLine(("",), "", "…", "note")]
    return lines


def _children(path: Path, message: Mapping[str, Value], is_open: IsOpen) -> Iterator[EchoLine]:
    widest = min(WIDEST_KEY, max(map(len, message), default=0)) + 1
    columns = places(message.values())
    for key, value in message.items():
        yield from _value((*path, key), f"{plain(key)}:".ljust(widest), value, columns, is_open)


def _value(path: Path, label: str, value: Value, columns: int, is_open: IsOpen) -> Iterator[EchoLine]:
    if is_branch(value):
        yield from _branch(path, label.rstrip(), value, is_open)
        return
    if is_number(value):
        yield EchoLine(path, label, aligned(value, columns), "number")
        return
    below = _contents(path, value, is_open)
    foldable = next(below, None)
    opened = is_open(path, False) if foldable else None
    kind = "text" if isinstance(value, str) else "bytes" if isinstance(value, bytes) else "number"
    yield EchoLine(path, label, scalar(value), kind, opened)
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
        counted = f"({items(len(value))})"
        yield EchoLine(path, label, counted, "branch", opened)
        if opened:
            yield from _numbered(path, value, is_open)


def _contents(path: Path, value: Value, is_open: IsOpen) -> Iterator[EchoLine]:
    """Return the contents of a leaf that can be opened; nothing if its own line shows all of it."""
    if isinstance(value, (str, bytes)):
        if len(value) > (CHUNK if isinstance(value, str) else HEX_CHUNK):
            yield from _chunks(path, value)
    elif isinstance(value, (np.ndarray, Sequence)):
        yield from _numbered(path, value, is_open)


def _numbered(
    path: Path, values: Sequence[Value] | np.ndarray[tuple[int, ...], np.dtype[np.generic]], is_open: IsOpen
) -> Iterator[EchoLine]:
    shown = min(len(values), OPENED_ITEMS)
    widest = len(f"[{shown - 1}]:")
    columns = places(values[:shown])
    for index in range(shown):
        label = f"[{index}]:".ljust(widest)
        yield from _value((*path, index), label, values[index], columns, is_open)
    rest = len(values) - shown
    if rest:
        text = ngettext("… {n} more item", "… {n} more items", rest).format(n=rest)
        yield EchoLine((*path, shown), "", text, "note")


def _chunks(path: Path, value: str | bytes) -> Iterator[EchoLine]:
    """Return a long text, or bytes, in lines of their own."""
    is_text = isinstance(value, str)
    size = CHUNK if is_text else HEX_CHUNK
    for start in range(0, min(len(value), size * OPENED_ITEMS), size):
        piece = value[start : start + size]
        if isinstance(piece, str):
            yield EchoLine((*path, start), "", plain(piece), "text")
        else:
            text = f"{start:06x}  {piece.hex(' '):{3 * HEX_CHUNK}} {printable(piece)}"
            yield EchoLine((*path, start), "", text, "bytes")
    rest = len(value) - size * OPENED_ITEMS
    if rest > 0:
        more = ngettext("… {n} more byte", "… {n} more bytes", rest)
        if is_text:
            more = ngettext("… {n} more character", "… {n} more characters", rest)
        yield EchoLine((*path, len(value) - rest), "", more.format(n=rest), "note")


SHOWN_CHARACTERS = 400
SHOWN_ITEMS = 48
SHOWN_BYTES = 24
FEW_PLACES, MANY_PLACES = 4, 10
"""Columns left of the decimal point: two steps, so that numbers do not shift the tree."""
DECIMALS = 6
TINY, HUGE = 1e-4, 1e9
FIRST_PRINTABLE, LAST_PRINTABLE = 0x20, 0x7E


def is_branch(value: Value) -> bool:
    """Whether the value is a message, or a list of messages or lists, rather than a leaf."""
    if isinstance(value, Mapping):
        return True
    is_list = isinstance(value, Sequence) and not isinstance(value, (str, bytes))
    return is_list and bool(value) and isinstance(value[0], (Mapping, list, tuple))  # type: ignore[index]


def is_number(value: Value | np.generic) -> TypeGuard[float | bool | np.generic]:
    return isinstance(value, (bool, int, float, np.generic))


def number(value: float | bool | np.generic) -> str:
    """Format a number briefly: at most six decimals, or an exponent if those would hide it."""
    plain_value = value.item() if isinstance(value, np.generic) else value
    if isinstance(plain_value, bool):
        return "true" if plain_value else "false"
    if isinstance(plain_value, int):
        return str(plain_value)
    if not isinstance(plain_value, float) or not math.isfinite(plain_value):
        return str(plain_value)
    if plain_value and not TINY <= abs(plain_value) < HUGE:
        return f"{plain_value:.6e}"
    whole, _, fraction = f"{plain_value:.{DECIMALS}f}".partition(".")
    return f"{whole}.{fraction.rstrip('0') or '0'}"


def places(values: Iterable[Value | np.generic]) -> int:
    """Number of columns left of the decimal point that aligns these numbers."""
    widest = max((len(number(v).partition(".")[0]) for v in values if is_number(v)), default=0)
    return FEW_PLACES if widest <= FEW_PLACES else MANY_PLACES


def aligned(value: float | bool | np.generic, columns: int) -> str:
    """Format a number with this many columns before its decimal point."""
    text = number(value)
    whole, dot, fraction = text.partition(".")
    return f"{whole:>{columns}}{dot}{fraction}"


def quoted(value: str) -> str:
    """A text in quotes; of a long one its length, then its beginning."""
    if len(value) <= SHOWN_CHARACTERS:
        return f'"{plain(value)}"'
    return f'({characters(len(value))}) "{plain(value, SHOWN_CHARACTERS)}…'


def hexadecimal(value: bytes) -> str:
    """Bytes by their number, and the first of them in hex and as text."""
    head = value[:SHOWN_BYTES]
    more = " …" if len(value) > len(head) else ""
    preview = f"  {head.hex(' ')}{more}  {printable(head)}" if head else ""
    count = ngettext("{n} byte", "{n} bytes", len(value)).format(n=len(value))
    return f"({count}){preview}"


def printable(value: bytes) -> str:
    return "".join(chr(b) if FIRST_PRINTABLE <= b <= LAST_PRINTABLE else "·" for b in value)


def array(values: Sequence[Value] | np.ndarray[tuple[int, ...], np.dtype[np.generic]]) -> str:
    head = values[:SHOWN_ITEMS]
    shown = " ".join(scalar(item) for item in head)
    more = " …" if len(values) > len(head) else ""
    return f"({items(len(values))})  {shown}{more}" if len(values) else f"({items(0)})"


def scalar(value: Value | np.generic) -> str:
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, bytes):
        return hexadecimal(value)
    if isinstance(value, np.ndarray):
        return array(value)
    if isinstance(value, (bool, int, float, np.generic)):
        return number(value)
    if isinstance(value, Mapping):
        return f"{{{len(value)}}}"
    return array(value)


def items(count: int) -> str:
    return ngettext("{n} item", "{n} items", count).format(n=count)


def characters(count: int) -> str:
    return ngettext("{n} character", "{n} characters", count).format(n=count)
