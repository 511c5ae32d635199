"""Messages as YAML, in the form of `ros2 topic echo`."""

from __future__ import annotations

import array
import sys
from typing import Any

import numpy as np
import yaml

Tree = Any
"""What a message becomes: mappings, lists, numbers, strings."""


class _Dumper(yaml.Dumper):
    """Keeps the order of the fields."""


class _Name(str):
    """A text that is one of several fields, such as the name of a frame: it stays in its line."""

    __slots__ = ()


_Dumper.add_representer(_Name, lambda _dumper, data: yaml.ScalarNode("tag:yaml.org,2002:str", str(data), style='"'))


_Dumper.add_representer(
    dict,
    lambda dumper, data: yaml.MappingNode(
        "tag:yaml.org,2002:map",
        [(dumper.represent_data(key), dumper.represent_data(value)) for key, value in data.items()],
    ),
)


def to_yaml(message: Any, longest: int | None = None, *, flow: bool = False) -> str:  # noqa: ANN401 - generated
    """Return a message as YAML; `longest`: elements of an array and characters of a text, None for all.

    With `flow` it is all in one line, with braces.
    """
    return yaml.dump(
        to_tree(message, longest), Dumper=_Dumper, allow_unicode=True, width=sys.maxsize, default_flow_style=flow
    )


def to_tree(message: Any, longest: int | None = None) -> dict[str, Tree]:  # noqa: ANN401 - generated
    """Return the fields of a message in order."""
    names = message.get_fields_and_field_types()
    tree = {name: _value(getattr(message, name), longest) for name in names}
    return tree if len(tree) < 2 else {name: _in_line(value) for name, value in tree.items()}


def _in_line(value: Tree) -> Tree:
    """Have texts with line breaks written with escapes; a message of one text may be a page."""
    if isinstance(value, list):
        return [_in_line(each) for each in value]
    return _Name(value) if isinstance(value, str) and "\n" in value else value


def _value(value: Any, longest: int | None) -> Tree:  # noqa: ANN401
    if isinstance(value, bytes):
        value = "".join(map(chr, value))
    if isinstance(value, str):
        return value if longest is None or len(value) <= longest else f"{value[:longest]}..."
    if isinstance(value, (list, tuple, array.array, np.ndarray)):
        elements = [_value(each, longest) for each in value[:longest]]
        return [*elements, "..."] if len(elements) < len(value) else elements
    if isinstance(value, np.number):
        return value.item()
    return value if isinstance(value, (bool, int, float)) else to_tree(value, longest)
