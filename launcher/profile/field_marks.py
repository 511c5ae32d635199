"""What the annotation of a field says beside its type, for whoever handles a profile unvalidated.

`launcher.profile.model` is the one place where a field is declared; these marks tell how its value
is read, where a path of it begins, and what `extends` does with it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from pydantic import BaseModel

M = TypeVar("M")


class AsText:
    """Every scalar within means the text that stands there: `0.10`, `yes`, `9`."""


class Joined:
    """`extends` joins the mapping key by key; what is not marked replaces the other profile's."""


@dataclass(frozen=True)
class PathFromProfile:
    """A path, relative to the profile that says it."""

    is_meant: Callable[[str], bool] = bool
    """Tells a path from another text that may stand there."""


def marked(model: type[BaseModel], mark: type[M]) -> dict[str, M]:
    """Return the fields with a mark of this type, by name."""
    return {
        name: found
        for name, field in model.model_fields.items()
        for found in field.metadata
        if isinstance(found, mark)
    }
