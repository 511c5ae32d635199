"""Marks in the annotation of a field, for code that handles a profile before validation.

Fields are declared in `launcher.profile.model` only; these marks say how a value is read, what a
path is relative to, and how `extends` treats it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from pydantic import BaseModel

M = TypeVar("M")


class AsText:
    """Every scalar inside is taken as text, exactly as written: `0.10`, `yes`, `9`."""


class Joined:
    """`extends` merges the mapping key by key; a field without this mark replaces the other's."""


@dataclass(frozen=True)
class PathFromProfile:
    """A path relative to the profile that contains it."""

    is_meant: Callable[[str], bool] = bool
    """Distinguishes a path from other text that is allowed here."""


def marked(model: type[BaseModel], mark: type[M]) -> dict[str, M]:
    """Return the fields with a mark of this type, by name."""
    return {
        name: found
        for name, field in model.model_fields.items()
        for found in field.metadata
        if isinstance(found, mark)
    }
