"""Fields of a message by their path, compared with what a check says, and shown."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

from text.sentences import say
from text.suggestions import did_you_mean

_PART = re.compile(r"([^.\[\]]+)|\[(-?[0-9]+)\]")
LONGEST = 80


class FieldMissingError(Exception):
    """A message has no field at this path."""


def field_at(value: Any, path: str) -> Any:  # noqa: ANN401 - any field
    """Return a field: `drive.speed`, `position[0]`. Raises FieldMissingError."""
    for name, index in _PART.findall(path):
        if name:
            if not isinstance(value, Mapping) or name not in value:
                hint = did_you_mean(name, value) if isinstance(value, Mapping) else ""
                words = say("there is no field {path}", path=path)
                raise FieldMissingError(say("{words}; {hint}", words=words, hint=hint) if hint else words)
            value = value[name]
        else:
            try:
                value = value[int(index)]
            except (IndexError, TypeError, KeyError) as error:
                words = say("{path}: there is no element {index}", path=path, index=index)
                raise FieldMissingError(words) from error
    return value.item() if hasattr(value, "item") and not getattr(value, "shape", ()) else value


def differs(wanted: Any, found: Any, tolerance: float | None) -> bool:  # noqa: ANN401 - any field
    """Whether a value is not the wanted one; of a mapping, only the wanted keys count."""
    if isinstance(wanted, Mapping):
        return not isinstance(found, Mapping) or any(
            key not in found or differs(inner, found[key], tolerance) for key, inner in wanted.items()
        )
    if isinstance(found, (bytes, bytearray)) and isinstance(wanted, str):
        return found.decode("utf-8", "replace") != wanted
    if _is_number(wanted) and _is_number(found):
        return _numbers_differ(float(wanted), float(found), tolerance)
    if hasattr(wanted, "tobytes") and hasattr(found, "tobytes") and wanted.tobytes() == found.tobytes():
        return False  # Two pictures, say: element by element takes long.
    if isinstance(wanted, (list, tuple)) or hasattr(found, "tolist"):
        wanted = wanted.tolist() if hasattr(wanted, "tolist") else list(wanted)
        found = found.tolist() if hasattr(found, "tolist") else list(found)
        return len(wanted) != len(found) or any(map(differs, wanted, found, [tolerance] * len(found)))
    return bool(wanted != found)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _numbers_differ(wanted: float, found: float, tolerance: float | None) -> bool:
    if math.isnan(wanted) or math.isnan(found):
        return math.isnan(wanted) != math.isnan(found)
    # Half of what a float32 rounds away counts as nothing.
    allowed = tolerance if tolerance is not None else 1e-6 * max(1.0, abs(wanted))
    return wanted != found and not abs(wanted - found) <= allowed


def shown(value: Any) -> str:  # noqa: ANN401 - any field
    """Return a field as a person reads it."""
    if isinstance(value, (bytes, bytearray)):
        text = value.decode("utf-8", "replace")
    elif isinstance(value, float):
        text = f"{value:.6g}"
    elif hasattr(value, "tolist"):
        text = shown(value.tolist())
    elif isinstance(value, list):
        text = "[" + ", ".join(map(shown, value[:LONGEST])) + "]"
    elif isinstance(value, Mapping):
        text = "{" + ", ".join(f"{key}: {shown(inner)}" for key, inner in value.items()) + "}"
    else:
        text = str(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
