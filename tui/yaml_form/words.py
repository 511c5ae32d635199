"""What is wrong with a YAML form, in the current language."""

from __future__ import annotations

import asyncio
from typing import TypeAlias

from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from text.i18n import _, localized
from text.plain import plain
from text.sentences import reason_of
from text.yaml_faults import YamlError
from tui.widgets.marked_editor import TextPlace

LONGEST = 300

Wrong: TypeAlias = YamlError | FieldError | UnknownTypeError
"""Everything that checking a form may raise."""


def place_of(error: Wrong) -> TextPlace | None:
    line = getattr(error, "line", None)
    return None if line is None else TextPlace(line, getattr(error, "column", None) or 1)


def wrong_words(error: Wrong) -> str:
    """The line, the field and the fix: `line 3: drive.speed: expected a number, got 'b'`."""
    place = place_of(error)
    line = "" if place is None else _("line {line}").format(line=place.line)
    field = error.field if isinstance(error, FieldError) else ""
    message = error.words if isinstance(error, UnknownTypeError) else error.message
    return plain(": ".join(part for part in (line, field, localized(message)) if part), LONGEST)


def reason_words(error: Exception) -> str:
    if isinstance(error, (YamlError, FieldError, UnknownTypeError)):
        return wrong_words(error)
    if isinstance(error, asyncio.TimeoutError):
        return _("ROS did not accept it in time")
    return plain(localized(reason_of(error)), LONGEST)
