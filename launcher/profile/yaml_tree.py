"""YAML to a tree with positions, built from PyYAML's events, so memory stays bounded.

Aliases share branches and are counted as if written out, depth is bounded, no tag constructs
anything. What a word stands for is said in `text.yaml_scalars`.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import yaml

from launcher.profile.tree import Branch, FilePlace, Listing, MappingEntry, Scalar
from text.sentences import say
from text.yaml_faults import YamlError, events
from text.yaml_scalars import meaning

if TYPE_CHECKING:
    from launcher.profile.tree import Problems, Tree

MAX_VALUES = 20_000
MAX_DEPTH = 24
TAG = "tag:yaml.org,2002:"


def read_yaml(text: str, file: str, problems: Problems) -> Branch | None:
    """Return the only document of `text`, a mapping, or None and problems that say why not."""
    read, root = _read(text, file, problems)
    if not read:
        return None
    if root is None or (isinstance(root, Scalar) and root.value is None):
        problems.add(
            FilePlace(file, 1, 1), (), say("is empty"), say("a profile has at least `nodes:`")
        )
        return None
    if not isinstance(root, Branch):
        kind = say("a list") if isinstance(root, Listing) else say("a single value")
        problems.add(root.place, (), say("expected keys and values, found {kind}", kind=kind))
        return None
    return root


def read_value(text: str, file: str, problems: Problems) -> Tree | None:
    """Return the value that a piece of YAML stands for, as of `--set`; None and a problem else."""
    read, root = _read(text, file, problems)
    return (root or Scalar("", "", FilePlace(file))) if read else None


def _read(text: str, file: str, problems: Problems) -> tuple[bool, Tree | None]:
    """Return whether it could be read, and the only document, None if there is none."""
    builder = _TreeBuilder(file, problems)
    try:
        for event in events(text):
            builder.take(event)
    except YamlError as error:
        problems.add(FilePlace(file, error.line, error.column), (), error.message)
        return False, None
    except _StopError:
        return False, None
    return True, builder.root


class _StopError(Exception):
    """A problem after which it makes no sense to read on."""


@dataclass
class _OpenCollection:
    """A mapping or a sequence that has not ended yet."""

    place: FilePlace
    anchor: str | None
    mapping: bool
    items: list[Tree] = field(default_factory=list)
    entries: dict[str, MappingEntry] = field(default_factory=dict)
    merged: list[Branch] = field(default_factory=list)
    key: tuple[str, FilePlace] | None = None
    size: int = 1


class _TreeBuilder:
    """Takes events, builds the tree."""

    def __init__(self, file: str, problems: Problems) -> None:
        self.root: Tree | None = None
        self._file = file
        self._problems = problems
        self._stack: list[_OpenCollection] = []
        self._anchors: dict[str, Tree] = {}
        self._constructor = yaml.constructor.SafeConstructor()

    def take(self, event: yaml.Event) -> None:
        """Take the next event."""
        if isinstance(event, yaml.DocumentStartEvent) and self.root is not None:
            self._stop(self._place(event), say("a second document begins; one file, one profile"))
        if isinstance(event, yaml.NodeEvent):
            self._check_tag(event)
        if isinstance(event, (yaml.MappingStartEvent, yaml.SequenceStartEvent)):
            self._open(event)
        elif isinstance(event, (yaml.MappingEndEvent, yaml.SequenceEndEvent)):
            opened = self._stack.pop()
            tree = _closed(opened)
            self._remember(opened.anchor, tree)
            self._put(tree)
        elif isinstance(event, yaml.ScalarEvent):
            scalar = self._scalar(event)
            self._remember(event.anchor, scalar)
            self._put(scalar, merge=event.style is None and event.value == "<<")
        elif isinstance(event, yaml.AliasEvent):
            self._put(self._alias(event))

    def _open(self, event: yaml.CollectionStartEvent) -> None:
        place = self._place(event)
        if len(self._stack) >= MAX_DEPTH:
            self._stop(place, say("is nested deeper than {limit} levels", limit=MAX_DEPTH))
        mapping = isinstance(event, yaml.MappingStartEvent)
        self._stack.append(_OpenCollection(place, event.anchor, mapping))

    def _put(self, tree: Tree, *, merge: bool = False) -> None:
        """Put a finished value where it belongs: the root, a list, a key or a key's value."""
        if not self._stack:
            self.root = tree
            return
        top = self._stack[-1]
        top.size += tree.size
        if top.size > MAX_VALUES:
            self._stop(
                tree.place,
                say("has more than {limit} values, counting aliases", limit=MAX_VALUES),
            )
        if not top.mapping:
            top.items.append(tree)
        elif top.key is None:
            top.key = ("<<" if merge else self._key(tree), tree.place)
        else:
            self._put_entry(top, top.key, tree)
            top.key = None

    def _put_entry(self, top: _OpenCollection, key: tuple[str, FilePlace], value: Tree) -> None:
        name, place = key
        if name == "<<":
            sources = value.items if isinstance(value, Listing) else (value,)
            top.merged += [source for source in sources if isinstance(source, Branch)]
            if not all(isinstance(source, Branch) for source in sources):
                self._problems.add(place, ("<<",), say("expected a mapping to merge"))
        elif name in top.entries:
            first = top.entries[name].key_place.line
            message = say("this key appears a second time; first on line {line}", line=first)
            self._problems.add(place, self._where(name), message, say("join them or rename one"))
        else:
            top.entries[name] = MappingEntry(place, value)

    def _key(self, tree: Tree) -> str:
        if isinstance(tree, Scalar):
            return tree.text
        self._stop(tree.place, say("expected a word as the key, found a list or a mapping"))
        raise AssertionError  # pragma: no cover

    def _where(self, name: str) -> tuple[str | int, ...]:
        """Return the path of a key of the mapping that is being read."""
        outer = (opened.key[0] if opened.key else len(opened.items) for opened in self._stack[:-1])
        return (*outer, name)

    def _remember(self, anchor: str | None, tree: Tree) -> None:
        if anchor is not None:
            self._anchors[anchor] = tree

    def _alias(self, event: yaml.AliasEvent) -> Tree:
        name = str(event.anchor)
        place = self._place(event)
        if any(opened.anchor == name for opened in self._stack):
            self._stop(place, say("*{name} contains itself", name=name))
        if name not in self._anchors:
            self._stop(
                place, say("*{name} refers to nothing: there is no &{name} before it", name=name)
            )
        return replace(self._anchors[name], place=place)

    def _scalar(self, event: yaml.ScalarEvent) -> Scalar:
        place = self._place(event)
        tag = event.tag
        if tag is None or tag == "!":
            is_text = bool(event.style) or tag == "!"
            return Scalar(event.value if is_text else meaning(event.value), event.value, place)
        try:
            construct = self._constructor.yaml_constructors[tag]
            value = construct(self._constructor, yaml.ScalarNode(tag, event.value))
        except (ValueError, KeyError, IndexError):
            kind = tag.removeprefix(TAG)
            self._problems.add(
                place, (), say("{text!r} is not a valid {kind}", text=event.value[:40], kind=kind)
            )
            value = None
        return Scalar(value, event.value, place)

    def _check_tag(self, event: yaml.NodeEvent) -> None:
        tag = getattr(event, "tag", None)
        known = {
            "!",
            *(TAG + kind for kind in ("str", "int", "float", "bool", "null", "seq", "map")),
        }
        if tag is not None and tag not in known:
            name = tag.replace(TAG, "!!")
            self._stop(
                self._place(event),
                say("the tag {name} is refused: a profile holds plain data", name=name),
            )

    def _place(self, event: yaml.Event) -> FilePlace:
        mark = event.start_mark
        return (
            FilePlace(self._file, mark.line + 1, mark.column + 1) if mark else FilePlace(self._file)
        )

    def _stop(self, place: FilePlace, message: str) -> None:
        self._problems.add(place, (), message)
        raise _StopError


def _closed(opened: _OpenCollection) -> Tree:
    if not opened.mapping:
        return Listing(tuple(opened.items), opened.place, opened.size)
    entries = dict(opened.entries)
    for source in opened.merged:
        for name, entry in source.entries.items():
            entries.setdefault(name, entry)
    return Branch(entries, opened.place, opened.size)
