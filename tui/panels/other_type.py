"""Messages of another type than a panel reads: reported in place of values."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _
from text.plain import plain
from tui.widgets.drawing import Placeholder

if TYPE_CHECKING:
    from graph.data import Sample

LONGEST = 200


def other_type(sample: Sample | None, awaited: str) -> Placeholder | None:
    """Return the received and the expected type; None if they are the same, or nothing arrives."""
    if sample is None or sample.type_name == awaited:
        return None
    words = _("{topic}: {type} comes; expected: {awaited}").format(
        topic=sample.topic, type=_short(sample.type_name), awaited=_short(awaited)
    )
    return Placeholder(_("messages arrive, but of another type"), plain(words, LONGEST))


def _short(type_name: str) -> str:
    return type_name.replace("/msg/", "/")
