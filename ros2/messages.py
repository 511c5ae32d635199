"""Messages on a command line: made from YAML, checked as all that Deck sends, and printed."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import yaml

from graph.messages.condition import ConditionError, MessageFilter
from graph.messages.fields import to_tree
from graph.messages.making import FieldError, draft
from graph.messages.types import UnknownTypeError, load_action, load_message, load_service
from graph.messages.yaml_text import read_fields
from ros2.verb import UsageError
from text.i18n import localized
from text.yaml_faults import YamlError
from text.yaml_tree import Branch, plain

if TYPE_CHECKING:
    from graph.messages.making import Draft

T = TypeVar("T")
_LOAD: Mapping[str, Callable[[str], type[Any]]] = {"msg": load_message, "srv": load_service, "action": load_action}


def load(type_name: str, kind: str) -> type[Any]:
    """Return the class of a type, where `pkg/Name` means `pkg/KIND/Name`; RuntimeError without one."""
    package, _, name = type_name.partition("/")
    try:
        return _LOAD[kind](type_name if "/" in name else f"{package}/{kind}/{name}")
    except UnknownTypeError as error:
        raise RuntimeError(localized(error.words)) from error


def read(text: str) -> Mapping[str, Any]:
    """Return the fields that a text in YAML has; RuntimeError if it is something else."""
    try:
        tree = read_fields(text)
    except YamlError as error:
        place = f"{error.line}:{error.column}"
        raise RuntimeError(f"The passed value is not YAML: {place}: {localized(error.message)}") from error
    if not isinstance(tree, Branch):
        raise RuntimeError("The passed value needs to be a dictionary in YAML format")  # noqa: TRY004 - told as it is
    return plain(tree)  # type: ignore[no-any-return]


def filled(cls: type[Any], values: Mapping[str, Any]) -> Draft:
    """Return a message with these fields; RuntimeError with the field and what it can hold."""
    try:
        return draft(cls, values)
    except FieldError as error:
        place = f"{error.field}: " if error.field else ""
        raise RuntimeError(f"Failed to populate field: {place}{localized(error.message)}") from error


def wanted(expression: str | None) -> Callable[[Any], bool]:
    """Return what decides on a message; UsageError for what is no expression, or asks for what no message has."""
    if expression is None:
        return lambda _message: True
    condition = _checked(expression, lambda: MessageFilter(expression))
    return lambda message: _checked(expression, lambda: condition.holds(_tree(message)))


def _checked(expression: str, do: Callable[[], T]) -> T:
    try:
        return do()
    except ConditionError as error:
        raise UsageError(f"Invalid filter expression '{expression}': {localized(error.words)}") from error


def _tree(value: Any) -> Any:  # noqa: ANN401 - a message, or what a field holds
    return to_tree(value) if hasattr(value, "get_fields_and_field_types") else value


def to_yaml(message: Any, longest: int | None = None) -> str:  # noqa: ANN401 - generated
    """Return a message as YAML; `longest`: elements of an array and characters of a text, None for all."""
    tree = _shown(to_tree(message), longest)
    text: str = yaml.safe_dump(tree, sort_keys=False, allow_unicode=True, width=sys.maxsize)
    return text


def _shown(value: Any, longest: int | None) -> Any:  # noqa: ANN401 - see `graph.data.Value`
    if isinstance(value, Mapping):
        return {name: _shown(each, longest) for name, each in value.items()}
    if isinstance(value, str):
        return value if longest is None or len(value) <= longest else f"{value[:longest]}..."
    if isinstance(value, (bool, int, float)):
        return value
    part = value[:longest]
    elements = part.tolist() if hasattr(part, "tolist") else [_shown(each, longest) for each in part]
    return [*elements, "..."] if len(part) < len(value) else elements
