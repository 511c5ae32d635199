"""Parameters as the YAML that `ros2 param dump` writes and `ros2 run --params-file` reads."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from graph.messages.yaml_reading import YamlNode, read
from text.sentences import say
from text.yaml_faults import YamlError, character_error
from text.yaml_scalars import quoted, written

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from graph.data import ParameterRow, Value

KEY = "ros__parameters"
DEEPEST = 16
"""Levels of nested names; a name of more parts is written with its dots."""
LONGEST_KEY = 1024
"""Characters of a key that may stand before its colon without a `?` (YAML 1.1, section 5.1)."""
NOT_WRITTEN = "bytes, which a file of parameters cannot hold"


def dump(node: str, parameters: Iterable[ParameterRow]) -> str:
    """Return the text of a file with these parameters of one node, in the order of their names.

    Those without a value are left out; bytes are named in a comment, as ROS reads none of a file.
    """
    rows = {row.name: row for row in sorted(parameters, key=lambda row: row.name)}
    tree: dict[str, object] = {}
    for name, row in rows.items():
        if row.value is not None:
            _place(tree, name, row, rows)
    if not tree:
        return f"{written(node)}:\n  {KEY}: {{}}\n"
    return "\n".join([f"{written(node)}:", f"  {KEY}:", *_lines(tree, "    ")]) + "\n"


def load(text: str, node: str) -> dict[str, Value]:
    """Return the parameters that a file's text has for a node, what stands later first of all.

    Takes what `dump` writes, several nodes in a file, and ROS's own wildcards (`/**`, `/*/arm`).
    Raises YamlError, with line and column.
    """
    if not text.strip():
        raise YamlError(1, 1, say("the file is empty"))
    found = list(_nodes(read(text), ""))
    values = {
        name: value
        for pattern, parameters in found
        if _pattern(pattern).fullmatch(node)
        for name, value in parameters.items()
    }
    if not values and not any(_pattern(pattern).fullmatch(node) for pattern, _ in found):
        names = ", ".join(dict.fromkeys(pattern for pattern, _ in found)) or "nobody"
        words = say("the file has nothing for {node}; it is for {names}", node=node, names=names)
        raise YamlError(1, 1, words)
    return values


def save_file(
    path: Path, node: str, parameters: Iterable[ParameterRow], *, replace: bool = False
) -> None:
    """Write a file that is either the old one or whole.

    Raises FileExistsError unless `replace`, and any other OSError of the file system.
    """
    path = Path(os.path.realpath(path)) if replace else path
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    with beside.open("x", encoding="utf-8") as file:
        try:
            file.write(dump(node, parameters))
            file.flush()
            if not replace:
                path.touch(exist_ok=False)
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)


def load_file(path: Path, node: str) -> dict[str, Value]:
    """Return what a file has for a node. Raises OSError, YamlError."""
    raw = path.read_bytes()
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise YamlError(line, 1, say("this is not UTF-8 text")) from error
    if "\0" in text:
        raise character_error(text, text.index("\0"))
    return load(text, node)


def _place(
    tree: dict[str, object], name: str, row: ParameterRow, rows: Mapping[str, object]
) -> None:
    """Nest a name by its dots, unless a part of it is the name of another parameter."""
    parts = name.split(".")
    above = [".".join(parts[:end]) for end in range(1, len(parts))]
    if not all(parts) or len(parts) > DEEPEST or any(each in rows for each in above):
        parts = [name]
    for part in parts[:-1]:
        tree = tree.setdefault(part, {})  # type: ignore[assignment]
    tree[parts[-1]] = row


def _lines(tree: Mapping[str, object], indent: str) -> Iterator[str]:
    for name, value in tree.items():
        text = written(name)
        key = f"{indent}{text}:" if len(text) <= LONGEST_KEY else f"{indent}? {text}\n{indent}:"
        if isinstance(value, dict):
            yield key
            yield from _lines(value, indent + "  ")
        else:
            row: ParameterRow = value  # type: ignore[assignment]
            is_bytes = isinstance(row.value, (bytes, bytearray))
            yield f"{indent}# {quoted(name)}: {NOT_WRITTEN}" if is_bytes else f"{key} {_text(row)}"


def _text(row: ParameterRow) -> str:
    value = row.value
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_scalar(each) for each in value)}]"
    return _scalar(value)


def _scalar(value: object) -> str:
    text = written(value)  # type: ignore[arg-type]
    # ROS reads some words otherwise than PyYAML, `y` and `1e5` among them: all texts in quotes.
    return f'"{text}"' if isinstance(value, str) and not text.startswith('"') else text


def _nodes(branch: YamlNode, path: str) -> Iterator[tuple[str, dict[str, Value]]]:
    """Yield nodes, or patterns for them, with their parameters."""
    for key, below in branch.value.items():
        if key == KEY:
            if not path:
                words = say(
                    "`{key}:` is not under any node; write the node's name, or `/**:`, above it",
                    key=KEY,
                )
                raise YamlError(below.key_line, below.key_column, words)
            parameters: dict[str, Value] = {}
            _flatten(_fields(below), "", parameters)
            yield path, parameters
            continue
        if not isinstance(below.value, dict):
            words = say(
                "expected `{key}:` under the name of a node, found {name} with a value",
                key=KEY,
                name=repr(key),
            )
            raise YamlError(below.key_line, below.key_column, words)
        yield from _nodes(below, f"{path}/{key.strip('/')}")


def _fields(node: YamlNode) -> YamlNode:
    if not isinstance(node.value, dict):
        words = say("expected parameters as `name: value`")
        raise YamlError(node.line, node.column, words)
    return node


def _flatten(branch: YamlNode, prefix: str, found: dict[str, Value]) -> None:
    for key, below in branch.value.items():
        name = f"{prefix}{key}"
        if isinstance(below.value, dict):
            _flatten(below, f"{name}.", found)
        elif name in found:
            words = say("the parameter {name} appears a second time", name=repr(name))
            raise YamlError(below.key_line, below.key_column, words)
        else:
            found[name] = _value(below, name)


def _value(node: YamlNode, name: str) -> Value:
    if node.value is None:
        line, column = node.key_line or node.line, node.key_column or node.column
        raise YamlError(line, column, say("{name} has no value", name=repr(name)))
    if isinstance(node.value, list):
        return _list(node, name)
    value: Value = node.value
    return value


def _list(node: YamlNode, name: str) -> Value:
    for each in node.value:
        if isinstance(each.value, (dict, list)):
            words = say("{name} is a list: expected a single value here", name=repr(name))
            raise YamlError(each.line, each.column, words)
    values = [_value(each, name) for each in node.value]
    kinds = {float if type(each) is int else type(each) for each in values}
    if len(kinds) > 1:
        words = say(
            "{name} has values of different types; a list of parameters has one type",
            name=repr(name),
        )
        raise YamlError(node.line, node.column, words)
    return values


def _pattern(pattern: str) -> re.Pattern[str]:
    """Return what matches the full names of the nodes that a key of a file is for."""
    tokens = {"*": "/[^/]+", "**": "(?:/[^/]+)*"}
    parts = pattern.strip("/").split("/")
    return re.compile("".join(tokens.get(part, "/" + re.escape(part)) for part in parts))
