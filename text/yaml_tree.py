"""A YAML text as a tree that remembers the position of everything in it.

Profiles, messages and parameters are all read here, each by its own rules, so the same mistake
gets the same message everywhere. Depth is bounded, no tag constructs anything; where aliases are
allowed, they share branches and are counted as if written out.

The tree is immutable; `plain` turns it into dicts, lists and single values, `place_of` finds the
position that an error message points at.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import yaml

from text.sentences import say
from text.yaml_faults import PLAIN, YamlError, composed, not_as_it_seems, space_meant, space_missing, wide_colon
from text.yaml_scalars import meaning

Where: TypeAlias = "tuple[str | int, ...]"
"""Path of a value: `("nodes", "sonar_front", "needs", 0)`."""
Tell: TypeAlias = Callable[[YamlError], None]
"""Takes an error after which reading can go on."""
TAG = "tag:yaml.org,2002:"
_KINDS: dict[str, type] = {
    f"{TAG}str": str,
    f"{TAG}int": int,
    f"{TAG}float": float,
    f"{TAG}bool": bool,
    f"{TAG}null": type(None),
}
_COLLECTIONS = {"mapping": f"{TAG}map", "sequence": f"{TAG}seq"}
_MERGE = "<<"


class FilePlace(NamedTuple):
    """A position in a file; line and column count from 1, or are both 0 for the file as a whole."""

    file: str
    """Its name as messages have it, empty for a text that is in none."""
    line: int = 0
    column: int = 0


@dataclass(frozen=True, slots=True)
class Scalar:
    """A value that is neither mapping nor sequence."""

    value: bool | int | float | str | None
    text: str
    """As written, without quotes: `1e3`, `yes`, `010`."""
    place: FilePlace


class MappingEntry(NamedTuple):
    """A key with its value."""

    key_place: FilePlace
    value: Tree


@dataclass(frozen=True, slots=True)
class Branch:
    """A mapping, in the order of the text."""

    entries: Mapping[str, MappingEntry]
    place: FilePlace


@dataclass(frozen=True, slots=True)
class Listing:
    """A sequence, in the order of the text."""

    items: tuple[Tree, ...]
    place: FilePlace


Tree: TypeAlias = Scalar | Branch | Listing


def field_name(where: Where) -> str:
    """Write a path in the usual form: `nodes.sonar_front.needs[0]`."""
    name = ""
    for part in where:
        name += f"[{part}]" if isinstance(part, int) else f".{part}" if name else part
    return name


def plain(tree: Tree) -> Any:  # noqa: ANN401 - anything YAML can express
    """Return the tree as dicts, lists and single values."""
    if isinstance(tree, Branch):
        return {key: plain(entry.value) for key, entry in tree.entries.items()}
    if isinstance(tree, Listing):
        return [plain(item) for item in tree.items]
    return tree.value


def empty(tree: Tree | None) -> bool:
    """Whether the value is empty, as after `params:` at the end of a line."""
    return tree is None or (isinstance(tree, Scalar) and tree.value is None)


def find(tree: Tree, where: Where) -> Tree | None:
    """Return the value at a path, None if there is none."""
    for part in where:
        entry = _below(tree, part)
        if entry is None:
            return None
        tree = entry.value
    return tree


def place_of(tree: Tree, where: Where, *, key: bool = False) -> FilePlace:
    """Return the place of a value, or with `key` of its key; if missing, of its nearest parent."""
    place = tree.place
    for depth, part in enumerate(where):
        entry = _below(tree, part)
        if entry is None:
            break
        tree = entry.value
        place = entry.key_place if key and depth == len(where) - 1 else tree.place
    return place


def _below(tree: Tree, part: str | int) -> MappingEntry | None:
    """Return what is one step down; an item of a list has its own place in place of a key's."""
    if isinstance(tree, Branch) and part in tree.entries:
        return tree.entries[str(part)]
    if isinstance(tree, Listing) and isinstance(part, int) and part < len(tree.items):
        item = tree.items[part]
        return MappingEntry(item.place, item)
    return None


def fault(place: FilePlace, message: str, where: Where = ()) -> YamlError:
    """Return the error to raise for a place; `where` is the path of the value that is wrong."""
    return YamlError(place.line, place.column, message, where)


@dataclass(frozen=True)
class Rules:
    """What a text may hold beside plain values, and how much."""

    shares: bool
    """Whether anchors, aliases and merges (`<<`) are allowed."""
    longest: int
    """Bytes."""
    deepest: int
    """Levels of nesting."""
    most: int = sys.maxsize
    """Values, with all aliases written out: aliases make many of few bytes."""
    joins: bool = False
    """Whether a name may appear again: its mappings are joined, else the last value counts."""


def read(text: str, rules: Rules, file: str = "", tell: Tell | None = None) -> Tree | None:
    """Return the only document of a text, None if there is none.

    Raises YamlError. Errors after which reading can go on are given to `tell`, if there is one.
    """
    if len(text.encode(errors="replace")) > rules.longest:
        raise YamlError(1, 1, say("is longer than {limit} KiB", limit=rules.longest // 1024))
    root = composed(text, shares=rules.shares)
    return None if root is None else _Reader(rules, file, tell or _raised).tree(root, ())


def mapping(tree: Tree) -> Branch:
    """Return a tree that has to be a mapping. Raises YamlError."""
    if isinstance(tree, Branch):
        return tree
    check_colons(tree)
    kind = say("nothing") if empty(tree) else say("a list") if isinstance(tree, Listing) else say("a single value")
    raise fault(tree.place, say("expected `name: value`, found {kind}", kind=kind))


def check_colons(tree: Tree) -> None:
    """Raise YamlError for `x:0`, alone or as a name without a value, where no name has a colon."""
    if isinstance(tree, Scalar):
        _check_colon(tree.text, tree.place)
    elif isinstance(tree, Branch):
        for name, entry in tree.entries.items():
            if empty(entry.value):
                _check_colon(name, entry.key_place)
            elif not isinstance(entry.value, Scalar):
                check_colons(entry.value)
    else:
        for item in tree.items:
            if not isinstance(item, Scalar):
                check_colons(item)


def _check_colon(text: str, place: FilePlace) -> None:
    wide = wide_colon(text)
    if wide is not None:
        raise not_as_it_seems(place.line, place.column + wide, text[wide])
    words = space_missing(text)
    if words is not None:
        raise fault(place, words)


def _raised(error: YamlError) -> None:
    raise error


class _Reader:
    """Turns PyYAML's nodes into a tree; a node that an alias repeats is turned only once."""

    def __init__(self, rules: Rules, file: str, tell: Tell) -> None:
        self._rules, self._file, self._tell = rules, file, tell
        self._above: list[yaml.Node] = []
        self._done: dict[yaml.Node, tuple[Tree, int]] = {}
        """Each collection that was read, and how many values it holds with all aliases written out."""
        self._count = 0

    def tree(self, node: yaml.Node, where: Where) -> Tree:
        place = self._place(node)
        if isinstance(node, yaml.ScalarNode):
            self._add(1, place)
            return Scalar(self._value(node, place), node.value, place)
        assert isinstance(node, (yaml.MappingNode, yaml.SequenceNode))
        if node.tag != _COLLECTIONS[node.id]:
            raise _refused(node.tag, place)
        if any(node is other for other in self._above):
            raise fault(place, say("this value contains itself, by an alias"))
        if len(self._above) >= self._rules.deepest:
            raise fault(place, say("is nested deeper than {limit} levels", limit=self._rules.deepest))
        if node in self._done:
            self._add(self._done[node][1], place)
            return self._done[node][0]
        before = self._count
        self._add(1, place)
        self._above.append(node)
        found: Tree
        if isinstance(node, yaml.SequenceNode):
            items = [self.tree(item, (*where, number)) for number, item in enumerate(node.value)]
            found = Listing(tuple(items), place)
        else:
            found = Branch(self._entries(node, where), place)
        self._above.pop()
        self._done[node] = found, self._count - before
        return found

    def _add(self, count: int, place: FilePlace) -> None:
        self._count += count
        if self._count > self._rules.most:
            raise fault(place, say("has more than {limit} values, counting aliases", limit=self._rules.most))

    def _entries(self, node: yaml.MappingNode, where: Where) -> dict[str, MappingEntry]:
        entries: dict[str, MappingEntry] = {}
        merged: list[Tree] = []
        for key, inner in node.value:
            place = self._place(key)
            if not isinstance(key, yaml.ScalarNode):
                raise fault(place, say("expected a name before the ':', found a list or a mapping"))
            name = key.value
            self._check(key, place, is_name=True)
            value = self.tree(inner, (*where, name))
            there = entries.get(name)
            if name == _MERGE and key.tag == PLAIN and self._rules.shares:
                sources = value.items if isinstance(value, Listing) else (value,)
                merged += sources
                if not all(isinstance(source, Branch) for source in sources):
                    self._tell(fault(place, say("expected a mapping to merge"), (*where, name)))
            elif there is None:
                entries[name] = MappingEntry(place, value)
            elif self._rules.joins:
                entries[name] = MappingEntry(there.key_place, _joined(there.value, value))
            else:
                words = say(
                    "{name} appears a second time, first on line {line}: join them or rename one",
                    name=repr(name),
                    line=there.key_place.line,
                )
                self._tell(fault(place, words, (*where, name)))
        for source in merged:
            for name, entry in source.entries.items() if isinstance(source, Branch) else ():
                entries.setdefault(name, entry)
        return entries

    def _check(self, node: yaml.ScalarNode, place: FilePlace, *, is_name: bool) -> None:
        """Refuse a tag that does not fit, and a character that is not what it seems to be."""
        if node.tag == PLAIN:
            odd = space_meant(node.value, is_name=is_name)
            if odd is not None:
                raise not_as_it_seems(place.line, place.column + odd, node.value[odd])
        elif node.tag not in _KINDS:
            raise _refused(node.tag, place)

    def _value(self, node: yaml.ScalarNode, place: FilePlace) -> bool | int | float | str | None:
        self._check(node, place, is_name=False)
        wanted = _KINDS.get(node.tag)
        text: str = node.value
        if wanted is str:
            return text
        value = meaning(text)
        if wanted is float and type(value) is int and abs(value) <= sys.float_info.max:
            value = float(value)
        if wanted is None or type(value) is wanted:
            return value
        words = say("{text!r} is not a valid {kind}", text=text[:40], kind=node.tag.removeprefix(TAG))
        self._tell(fault(place, words))
        return None

    def _place(self, node: yaml.Node) -> FilePlace:
        return FilePlace(self._file, node.start_mark.line + 1, node.start_mark.column + 1)


def _refused(tag: str, place: FilePlace) -> YamlError:
    return fault(place, say("the tag {tag} is refused: only plain values are read", tag=tag.replace(TAG, "!!")))


def _joined(first: Tree, again: Tree) -> Tree:
    if not isinstance(first, Branch) or not isinstance(again, Branch):
        return again
    entries = dict(first.entries)
    for name, entry in again.entries.items():
        there = entries.get(name)
        value = entry.value if there is None else _joined(there.value, entry.value)
        entries[name] = MappingEntry(entry.key_place, value)
    return Branch(entries, first.place)
