"""Where a part of a lesson is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from textual.content import Content
    from textual.widgets import Static


def put(place: Static, content: Content) -> None:
    """Change the text of a widget; an unchanged one costs nothing, an empty one no line."""
    place.display = bool(content)
    if place.content != content:
        place.update(content)
