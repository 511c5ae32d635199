"""Marking English sentences of this room for the catalogue of the screen."""

from __future__ import annotations


def N_(message: str) -> str:  # noqa: N802 - gettext's own name
    """Mark `message` for the catalogue; whoever shows it looks it up there."""
    return message
