"""Sentences as JSON, so that they can still be translated in another process."""

from __future__ import annotations

from typing import Any

from text.sentences import InLanguages, Words, say


def pack_text(text: str) -> Any:  # noqa: ANN401 - JSON
    """Return a sentence in a form that can be translated at the other end."""
    if isinstance(text, InLanguages):
        return text.texts
    if isinstance(text, Words) and text.values:
        return [text.template, {key: _pack_value(value) for key, value in text.values.items()}]
    return str(text) if not isinstance(text, Words) else [text.template, {}]


def _pack_value(value: object) -> Any:  # noqa: ANN401 - JSON
    if isinstance(value, str):
        return pack_text(value)
    return value if isinstance(value, (int, float)) or value is None else str(value)


def unpack_text(packed: Any) -> str:  # noqa: ANN401 - JSON
    """Return the sentence that `pack_text` was given."""
    if isinstance(packed, str):
        return packed
    if isinstance(packed, dict):
        return InLanguages(packed)
    template, values = packed
    unpacked = {
        key: unpack_text(value) if isinstance(value, (str, list, dict)) else value for key, value in values.items()
    }
    return say(template, **unpacked)
