"""A parameter in words: its value as typed, and its allowed values."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from text.i18n import N_, _
from text.plain import is_plain, plain
from text.yaml_scalars import in_quotes, unquoted

if TYPE_CHECKING:
    from graph.data import ParameterRow, Value

LONGEST = 400
UNITS = (
    N_("m"), N_("s"), N_("ms"), N_("Hz"), N_("V"), N_("rad"), N_("deg"), N_("m/s"), N_("rad/s"),
    N_("deg/s"),
)  # fmt: skip
MEASURE = re.compile(r"(?P<least>\S+) \.\. (?P<greatest>\S+)(?: (?P<unit>\S+))?")
"""The notation of Deck's own nodes for a range in their constraints."""


def typed(value: Value | None) -> str:
    """Return a value as one would type it: a text unchanged, a list with commas in brackets.

    A text with invisible parts is in double quotes, with escapes; `meant` reverses that.
    """
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value if is_plain(value) and unquoted(value) is None else in_quotes(value)
    if isinstance(value, (bytes, bytearray)):
        return "[" + ", ".join(map(str, value)) + "]"
    if isinstance(value, (int, float)):
        return repr(value)
    # Quotes keep a text in a list from being taken for a number.
    items = [in_quotes(item) if isinstance(item, str) else typed(item) for item in _items(value)]
    return "[" + ", ".join(items) + "]"


def meant(text: str) -> str:
    """Return the text that was meant: what is between double quotes, otherwise all of it."""
    between = unquoted(text)
    return text if between is None else between


def value_text(value: Value | None) -> str:
    """Return a value as one line of a table, with control characters made harmless."""
    return _("not set") if value is None else plain(typed(value), LONGEST)


def allowed_words(row: ParameterRow) -> str:
    """Return the range, the step, and whether it can be changed at all."""
    parts, constraints = [], row.constraints
    if row.read_only:
        parts.append(_("read-only"))
    if row.least is not None and row.greatest is not None:
        least, greatest = _number(row.least), _number(row.greatest)
        words = f"{least}…{greatest}"
        told = MEASURE.fullmatch(constraints)
        if told and _same(told["least"], least) and _same(told["greatest"], greatest):
            # The constraints only repeat the range, with all its digits and its unit.
            unit, constraints = told["unit"] or "", ""
            words = plain(f"{told['least']}…{told['greatest']}", LONGEST)
            words = f"{words} {_(unit) if unit in UNITS else plain(unit, LONGEST)}".rstrip()
        parts.append(words)
    if row.step:
        parts.append(_("step {n}").format(n=_number(row.step)))
    if constraints:
        parts.append(plain(_(constraints), LONGEST))
    return ", ".join(parts)


def _number(value: float) -> str:
    return f"{value:g}"


def _same(told: str, number: str) -> bool:
    try:
        return _number(float(told)) == number
    except ValueError:
        return False


def _items(value: Value) -> list[Value]:
    items: Any = value.tolist() if hasattr(value, "tolist") else value
    return list(items)
