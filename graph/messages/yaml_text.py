"""Messages as YAML, as `ros2 topic echo` and `ros2 topic pub` have it, and such YAML read again.

What is read are plain values only, without anchors and aliases.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from text.sentences import say
from text.yaml_faults import YamlError
from text.yaml_reading import Rules, check_colons, mapping
from text.yaml_reading import read as read_tree
from text.yaml_scalars import written
from text.yaml_tree import Listing, empty, plain

if TYPE_CHECKING:
    from collections.abc import Iterator

    from graph.data import Value
    from text.yaml_tree import Branch, Tree

RULES = Rules(shares=False, longest=1024 * 1024, deepest=64)
LONGEST_TEXT = 64 * 1024
"""Characters of a text, where arrays are cut too: what a terminal still takes as a clipboard."""


def to_yaml(tree: Mapping[str, Value], most: int | None = None, remark: Callable[[str], str] | None = None) -> str:
    """Return a message's tree as YAML, fields in their order, a line end at its end.

    Arrays of more than `most` elements are cut with a comment that tells their length; None cuts
    nothing. `remark` gives the comment for the field of a path such as `points[2].x`.
    """
    return "\n".join(_Writer(most, remark or _no_remark).fields(tree, "", "")) + "\n"


def is_cut(tree: Value, most: int) -> bool:
    """Tell whether `to_yaml` with this `most` leaves something out."""
    if isinstance(tree, Mapping):
        return any(is_cut(value, most) for value in tree.values())
    if isinstance(tree, str):
        return len(tree) > LONGEST_TEXT
    if isinstance(tree, (bool, int, float)):
        return False
    nested = tree if isinstance(tree, (list, tuple)) else ()
    return len(tree) > most or any(is_cut(value, most) for value in nested)


def _no_remark(_path: str) -> str:
    return ""


class _Writer:
    """Writes lines."""

    def __init__(self, most: int | None, remark: Callable[[str], str]) -> None:
        self._most = most
        self._remark = remark

    def fields(self, tree: Mapping[str, Value], path: str, indent: str) -> Iterator[str]:
        """Yield the lines of a message."""
        if not tree:
            yield indent + "{}"
        for name, value in tree.items():
            below = f"{path}.{name}" if path else name
            yield from self._value(f"{indent}{written(name)}:", value, below, indent)

    def _value(self, head: str, value: Value, path: str, indent: str) -> Iterator[str]:
        """Yield the lines of a value; `head` is what stands before it."""
        remark = self._remark(path)
        if isinstance(value, Mapping):
            yield _commented(head if value else f"{head} {{}}", remark)
            if value:
                yield from self.fields(value, path, indent + "  ")
        elif isinstance(value, (bool, int, float, str)):
            yield self._single(head, value, remark)
        else:
            yield from self._many(head, value, path, indent, remark)

    def _single(self, head: str, value: bool | float | str, remark: str) -> str:
        if self._most is not None and isinstance(value, str) and len(value) > LONGEST_TEXT:
            remark = f"the first {LONGEST_TEXT} of {len(value)} characters"
            value = value[:LONGEST_TEXT]
        return _commented(f"{head} {written(value)}", remark)

    def _many(self, head: str, value: Any, path: str, indent: str, remark: str) -> Iterator[str]:  # noqa: ANN401 - bytes, an array of numpy's, or a list
        shown = value
        if self._most is not None and len(value) > self._most:
            shown = value[: self._most]
            remark = f"the first {self._most} of {len(value)} elements"
        elements = _elements(shown)
        if all(isinstance(each, (bool, int, float, str)) for each in elements):
            yield _commented(f"{head} [{', '.join(map(written, elements))}]", remark)
            return
        yield _commented(head, remark)
        for index, each in enumerate(elements):
            yield from self._element(each, f"{path}[{index}]", indent)

    def _element(self, element: Value, path: str, indent: str) -> Iterator[str]:
        if not isinstance(element, Mapping) or not element:
            yield from self._value(f"{indent}-", element, path, indent + "  ")
            return
        lines = self.fields(element, path, indent + "  ")
        yield f"{indent}- {next(lines).lstrip()}"
        yield from lines


def _elements(value: Any) -> list[Any]:  # noqa: ANN401 - bytes, an array of numpy's, or a list
    dtype = getattr(value, "dtype", None)
    if dtype is None:
        return list(value)
    if dtype.name == "float32":
        # 0.1 and not 0.10000000149011612: its shortest form makes the same float32 again.
        return [float(str(each)) for each in value]
    elements: list[Any] = value.tolist()
    return elements


def _commented(line: str, remark: str) -> str:
    return f"{line}  # {remark}" if remark else line


def read(text: str, rules: Rules = RULES) -> Branch | None:
    """Return the only document of `text`, a mapping, None if there is nothing. Raises YamlError."""
    root = read_tree(text, rules)
    return None if root is None or empty(root) else mapping(root)


def read_message(text: str) -> Branch:
    """Return the fields of a message. Raises YamlError."""
    root = read_fields(text)
    if root is None or empty(root):
        raise YamlError(1, 1, say("is empty: write {} for a message with nothing but defaults"))
    return mapping(root)


def read_fields(text: str) -> Tree | None:
    """Return what stands in a text that should be the fields of a message. Raises YamlError."""
    root = read_tree(text, RULES)
    if root is not None:
        check_colons(root)
    if isinstance(root, Listing):
        for item in root.items:
            check_colons(item)
    return root


def value_of(text: str) -> Any:  # noqa: ANN401 - whatever was written
    """Return the value that the only document of `text` is, None for nothing. Raises YamlError."""
    root = read_tree(text, RULES)
    return None if root is None else plain(root)
