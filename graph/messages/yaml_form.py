"""A message to be filled in as YAML: every field at its default, its type in a comment."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

from graph.messages.fields import fields_of, parse, ros_name, to_tree
from graph.messages.making import FieldError, NoSuchFieldError, draft, with_words
from graph.messages.types import kind_of, load_action, load_message, load_service
from graph.messages.yaml_text import read_message, to_yaml
from text.yaml_tree import Branch, Listing, Scalar, field_name, find, place_of, plain

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from graph.data import Value
    from text.yaml_tree import FilePlace, Tree, Where


MOST_NAMES = 6
"""Fields of an element that are named where a list of messages is empty."""


def form_class(type_name: str) -> type[Any]:
    """Return the class of a message, of a service's request or of an action's goal.

    Raises UnknownTypeError.
    """
    kind = kind_of(type_name)
    if kind == "srv":
        request: type[Any] = load_service(type_name).Request
        return request
    if kind == "action":
        goal: type[Any] = load_action(type_name).Goal
        return goal
    return load_message(type_name)


@lru_cache(maxsize=128)
def prefilled(type_name: str) -> str:
    """Return YAML with every field at its default, and its type in a comment; `{}` for none.

    The stamp of a header is the word `now`, the time of sending.

    For `pkg/msg/X`, for the request of `pkg/srv/X`, for the goal of `pkg/action/X`. Raises
    UnknownTypeError.
    """
    return filled(type_name, to_tree(form_class(type_name)()))


def filled(type_name: str, tree: Mapping[str, Value], most: int | None = None) -> str:
    """Return YAML of a whole message to be sent, with the type of each field in a comment.

    The stamp of a header is the word `now`: the one it had is no longer true. Arrays are cut at
    `most` elements; a comment tells. Raises UnknownTypeError.
    """
    cls = form_class(type_name)
    tree = with_words(cls, tree)
    remarks = dict(_remarks(cls, tree, "", most))
    return to_yaml(tree, most, lambda path: remarks.get(path, ""))


def check(type_name: str, text: str) -> Mapping[str, Value]:
    """Return the fields that were filled in; those left out are at their defaults.

    Raises YamlError, FieldError with the field's line and column, or UnknownTypeError.
    """
    cls = form_class(type_name)
    root = read_message(text)
    tree: Mapping[str, Value] = plain(root)
    try:
        draft(cls, tree)
    except FieldError as error:
        place = _place(root, error)
        error.line, error.column = place.line, place.column
        raise
    return tree


def _place(root: Branch, error: FieldError) -> FilePlace:
    """Return what to point at: a single value, or the name that stands before anything else."""
    where = _where(root, error.field)
    at_key = isinstance(error, NoSuchFieldError) or not isinstance(find(root, where), Scalar)
    return place_of(root, where, key=at_key)


def _where(tree: Tree, field: str, above: Where = ()) -> Where:
    """Return the path of a field such as `points[2].x`, or of the nearest that is around it."""
    for part, below in _parts(tree):
        where = (*above, part)
        name = field_name(where)
        if name == field:
            return where
        if field.startswith((f"{name}.", f"{name}[")):
            return _where(below, field, where)
    return above


def _parts(tree: Tree) -> Iterator[tuple[str | int, Tree]]:
    if isinstance(tree, Branch):
        yield from ((name, entry.value) for name, entry in tree.entries.items())
    elif isinstance(tree, Listing):
        yield from enumerate(tree.items)


def _remarks(
    cls: type[Any],
    tree: Any,  # noqa: ANN401 - a message's tree
    prefix: str,
    most: int | None,
) -> Iterator[tuple[str, str]]:
    """Yield paths and types of all that is no message in a message itself."""
    for name, text in fields_of(cls):
        kind = parse(text)
        path = f"{prefix}{name}"
        value = tree[name]
        if kind.is_message and isinstance(value, str):
            yield path, ros_name(text)
        elif kind.is_message and len(value):
            nested = load_message(kind.message_type)
            parts = [("", value)]
            if kind.is_many:
                parts = [(f"[{index}]", each) for index, each in enumerate(value[:most])]
                yield path, _many(text, nested)
            for index, each in parts:
                yield from _remarks(nested, each, f"{path}{index}.", most)
        elif kind.is_message:
            yield path, _many(text, load_message(kind.message_type))
        else:
            yield path, ros_name(text)


def _many(text: str, element: type[Any]) -> str:
    """Say what a list of messages holds: `geometry_msgs/Point32[] of {x, y, z}`."""
    names = [name for name, _kind in fields_of(element)]
    shown = ", ".join(names[:MOST_NAMES]) + (", …" if len(names) > MOST_NAMES else "")
    return f"{ros_name(text)} of {{{shown}}}"
