"""Parameters as the YAML that `ros2 param dump` writes and `ros2 run --params-file` reads."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from graph.messages.yaml_text import RULES, read
from text.sentences import say
from text.yaml_faults import YamlError, character_error, fault
from text.yaml_reading import check_colons, mapping
from text.yaml_scalars import quoted, written
from text.yaml_tree import Branch, Listing, Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from graph.data import ParameterRow, Value
    from text.yaml_tree import FilePlace

KEY = "ros__parameters"
DEEPEST = 16
"""Levels of nested names; a name with more parts is written with dots."""
LONGEST_KEY = 1024
"""Characters of a key that may stand before its colon without a `?` (YAML 1.1, section 5.1)."""
AGAIN = replace(RULES, joins=True)
NOT_WRITTEN = "bytes, which a file of parameters cannot hold"


def dump(node: str, parameters: Iterable[ParameterRow]) -> str:
    """Return the text of a file with these parameters of one node, sorted by name.

    Those without a value are left out; bytes are only named in a comment, as ROS cannot read them
    from a file.
    """
    rows = {row.name: row for row in sorted(parameters, key=lambda row: row.name)}
    tree: dict[str, object] = {}
    for name, row in rows.items():
        if row.value is not None:
            _place(tree, name, row, rows)
    if not tree:
        return f"{written(node)}:\n  {KEY}: {{}}\n"
    return "\n".join([f"{written(node)}:", f"  {KEY}:", *_lines(tree, "    ")]) + "\n"


def load(text: str, node: str, *, wildcards: bool = True) -> dict[str, Value]:
    """Return the parameters that a file's text has for a node; later entries take precedence.

    Takes what `dump` writes, several nodes in a file, and ROS's own wildcards (`/**`, `/*/arm`),
    unless without `wildcards`. A name that appears again is taken as rcl_yaml_param_parser does: it
    stays where it was first, and what is in it is added. Raises YamlError, with line and column.
    """
    root = read(text, AGAIN)
    if root is None:
        raise YamlError(1, 1, say("the file is empty"))
    check_colons(root)
    found = [each for each in _nodes(root, "") if wildcards or "*" not in each[0]]
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


def save_file(path: Path, node: str, parameters: Iterable[ParameterRow], *, replace: bool = False) -> None:
    """Write a file atomically: it is either the old one or the complete new one.

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


def load_file(path: Path, node: str, *, wildcards: bool = True) -> dict[str, Value]:
    """Return what a file has for a node. Raises OSError, YamlError."""
    raw = path.read_bytes()
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise YamlError(line, 1, say("this is not UTF-8 text")) from error
    if "\0" in text:
        raise character_error(text, text.index("\0"))
    return load(text, node, wildcards=wildcards)


def _place(tree: dict[str, object], name: str, row: ParameterRow, rows: Mapping[str, object]) -> None:
    """Nest a name at its dots, unless a part of it is the name of another parameter."""
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
    # ROS reads some words differently from PyYAML, such as `y` and `1e5`: quote all texts.
    return f'"{text}"' if isinstance(value, str) and not text.startswith('"') else text


def _nodes(branch: Branch, path: str) -> Iterator[tuple[str, dict[str, Value]]]:
    """Yield nodes, or patterns for them, with their parameters."""
    for key, entry in branch.entries.items():
        if key == KEY:
            if not path:
                words = say("`{key}:` is not under any node; write the node's name, or `/**:`, above it", key=KEY)
                raise fault(entry.key_place, words)
            parameters: dict[str, Value] = {}
            _flatten(mapping(entry.value), "", parameters)
            yield path, parameters
            continue
        if not isinstance(entry.value, Branch):
            words = say(
                "expected `{key}:` under the name of a node, found {name} with a value", key=KEY, name=repr(key)
            )
            raise fault(entry.key_place, words)
        yield from _nodes(entry.value, f"{path}/{key.strip('/')}")


def _flatten(branch: Branch, prefix: str, found: dict[str, Value]) -> None:
    for key, entry in branch.entries.items():
        name = f"{prefix}{key}"
        if isinstance(entry.value, Branch):
            _flatten(entry.value, f"{name}.", found)
        elif isinstance(entry.value, Listing):
            found[name] = _list(entry.value, name)
        else:
            found[name] = _single(entry.value, entry.key_place, name)


def _single(scalar: Scalar, place: FilePlace, name: str) -> Value:
    if scalar.value is None:
        raise fault(place, say("{name} has no value", name=repr(name)))
    return scalar.value


def _list(listing: Listing, name: str) -> Value:
    values = []
    for item in listing.items:
        if not isinstance(item, Scalar):
            words = say("{name} is a list: expected a single value here", name=repr(name))
            raise fault(item.place, words)
        values.append(_single(item, item.place, name))
    kinds = {float if type(each) is int else type(each) for each in values}
    if len(kinds) > 1:
        words = say("{name} has values of different types; a list of parameters has one type", name=repr(name))
        raise fault(listing.place, words)
    return values


def _pattern(pattern: str) -> re.Pattern[str]:
    r"""Return a pattern for the full names of the nodes that a key of a file applies to.

    As rclcpp makes it: `/*` stands for `(/\w+)`, and any other `*` is one of regular expressions.
    Source: rclcpp/src/rclcpp/parameter_map.cpp.
    """
    text = re.escape("/" + pattern.strip("/")).replace(r"/\*", r"(?:/\w+)").replace(r"\*", "*")
    try:
        return re.compile(text)
    except re.error:
        return re.compile(re.escape(pattern))
