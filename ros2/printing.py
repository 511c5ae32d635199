"""Messages as text: YAML and comma-separated values, in the form of `ros2 topic echo`."""

from __future__ import annotations

import array
import sys
from dataclasses import dataclass
from typing import Any

import numpy as np
import yaml

from text.plain import plain

Tree = Any
"""What a message becomes: mappings, lists, numbers, strings."""
MANY = (list, tuple, array.array, np.ndarray)


@dataclass(frozen=True)
class Shape:
    """How much of a message is printed."""

    longest: int | None = None
    """Elements of an array and characters of a text, None for all."""
    arrays: bool = True
    strings: bool = True
    flow: bool = False
    """All in one line, with braces."""


WHOLE = Shape()


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


def to_yaml(message: Any, shape: Shape = WHOLE) -> str:  # noqa: ANN401 - generated
    """Return a message as YAML."""
    return yaml.dump(
        to_tree(message, shape), Dumper=_Dumper, allow_unicode=True, width=sys.maxsize, default_flow_style=shape.flow
    )


def to_tree(message: Any, shape: Shape = WHOLE) -> dict[str, Tree]:  # noqa: ANN401 - generated
    """Return the fields of a message in order."""
    names = message.get_fields_and_field_types()
    kinds = zip(names, message.SLOT_TYPES, strict=False)
    tree = {name: _value(getattr(message, name), shape, kind) for name, kind in kinds}
    return tree if len(tree) < 2 else {name: _in_line(value) for name, value in tree.items()}


def _in_line(value: Tree) -> Tree:
    """Have texts with line breaks written with escapes; a message of one text may be a page."""
    if isinstance(value, list):
        return [_in_line(each) for each in value]
    return _Name(value) if isinstance(value, str) and "\n" in value else value


def _value(value: Any, shape: Shape, kind: object = None) -> Tree:  # noqa: ANN401
    if isinstance(value, bytes):
        return _cut("".join(map(chr, value)), shape)
    if isinstance(value, str):
        return _cut(value, shape) if shape.strings else f"<string length: <{len(value)}>>"
    if isinstance(value, MANY):
        return _many(value, shape, kind)
    if isinstance(value, np.number):
        return value.item()
    return value if isinstance(value, (bool, int, float)) else to_tree(value, shape)


def _many(value: Any, shape: Shape, kind: object) -> Tree:  # noqa: ANN401
    if not shape.arrays and kind is not None:
        return _abbreviated(value, kind)
    longest = shape.longest
    is_cut = longest is not None and len(value) > longest
    elements = [_value(each, shape) for each in (value[:longest] if is_cut else value)]
    return [*elements, "..."] if is_cut else elements


def _cut(text: str, shape: Shape) -> str:
    longest = shape.longest
    return text if longest is None or len(text) <= longest else f"{text[:longest]}..."


def _abbreviated(value: Any, kind: Any) -> str:  # noqa: ANN401 - a type of rosidl_parser
    from rosidl_parser import definition as types

    name = _type_name(kind.value_type)
    if isinstance(kind, types.Array):
        return f"<array type: {name}[{kind.size}]>"
    if isinstance(kind, types.BoundedSequence):
        return f"<sequence type: {name}[{kind.maximum_size}], length: {len(value)}>"
    return f"<sequence type: {name}, length: {len(value)}>"


def _type_name(kind: Any) -> str:  # noqa: ANN401 - a type of rosidl_parser
    from rosidl_parser import definition as types

    if isinstance(kind, types.BasicType):
        return str(kind.typename)
    if isinstance(kind, types.AbstractString):
        return "string"
    if isinstance(kind, types.AbstractWString):
        return "wstring"
    if isinstance(kind, types.NamespacedType):
        return "/".join(kind.namespaced_name())
    return str(kind.name) if isinstance(kind, types.NamedType) else "unknown"


def to_csv(message: Any, shape: Shape = WHOLE) -> str:  # noqa: ANN401 - generated
    """Return the values of a message, separated by commas."""
    names = message.get_fields_and_field_types()
    kinds = zip(names, message.SLOT_TYPES, strict=False)
    return ",".join(_csv(getattr(message, name), shape, kind) for name, kind in kinds)


def _csv(value: Any, shape: Shape, kind: object = None) -> str:  # noqa: ANN401
    if isinstance(value, MANY):
        if not shape.arrays and kind is not None:
            return _abbreviated(value, kind)
        longest = len(value) if shape.longest is None else shape.longest
        parts = [_csv(each, shape) for each in value[:longest]]
        return ",".join([*parts, "..."] if len(value) > longest else parts)
    if isinstance(value, str):
        # A line break would begin another row.
        return plain(_cut(value, shape)) if shape.strings else f"<string length: <{len(value)}>>"
    if isinstance(value, bytes):
        cut = shape.longest is not None and len(value) > shape.longest
        return str(value[: shape.longest] + b"..." if cut else value)
    if isinstance(value, (bool, int, float, np.number)):
        return str(value)
    return to_csv(value, shape)
