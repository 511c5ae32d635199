"""Messages from the YAML of a command line, checked as everything is that Deck sends."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graph.messages.making import FieldError, draft
from graph.messages.yaml_text import read_fields
from text.i18n import localized
from text.yaml_faults import YamlError
from text.yaml_tree import Branch, plain

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.messages.making import Draft


def read(text: str) -> Mapping[str, Any] | None:
    """Return the fields that a text in YAML has; None if it is something else."""
    try:
        tree = read_fields(text)
    except YamlError as error:
        place = f"{error.line}:{error.column}"
        raise RuntimeError(f"The passed value is not YAML: {place}: {localized(error.message)}") from error
    return plain(tree) if isinstance(tree, Branch) else None


def filled(cls: type[Any], values: Mapping[str, Any], what: str = "field") -> Draft:
    """Return a message with these fields; RuntimeError with the field and what it can hold."""
    try:
        return draft(cls, values)
    except FieldError as error:
        words = localized(error.message)
        place = f"{error.field}: " if error.field else ""
        raise RuntimeError(f"Failed to populate {what}: {place}{words}") from error
