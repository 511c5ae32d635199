"""One value of a message as one short line, however long or malformed it is."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, TypeGuard

import numpy as np

from text.i18n import ngettext
from text.plain import plain

if TYPE_CHECKING:
    from graph.data import Value

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
    return is_list(value) and bool(value) and isinstance(value[0], (Mapping, list, tuple))


def is_list(value: Value) -> TypeGuard[Sequence[Value]]:
    """Whether the value is an array of something other than numbers."""
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def is_number(value: Value | np.generic) -> TypeGuard[float | bool | np.generic]:
    """Whether the value is a number or a boolean."""
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
    return f"({byte_count(len(value))}){preview}"


def printable(value: bytes) -> str:
    """Bytes as ASCII text, with a dot for each one that is not printable."""
    return "".join(chr(b) if FIRST_PRINTABLE <= b <= LAST_PRINTABLE else "·" for b in value)


def array(values: Sequence[Value] | np.ndarray[tuple[int, ...], np.dtype[np.generic]]) -> str:
    """An array as its length and its first items."""
    head = values[:SHOWN_ITEMS]
    shown = " ".join(scalar(item) for item in head)
    more = " …" if len(values) > len(head) else ""
    return f"({items(len(values))})  {shown}{more}" if len(values) else f"({items(0)})"


def scalar(value: Value | np.generic) -> str:
    """One value that is not a branch."""
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
    """A number of items, in words."""
    return ngettext("{n} item", "{n} items", count).format(n=count)


def characters(count: int) -> str:
    """A number of characters, in words."""
    return ngettext("{n} character", "{n} characters", count).format(n=count)


def byte_count(count: int) -> str:
    """A number of bytes, in words."""
    return ngettext("{n} byte", "{n} bytes", count).format(n=count)
