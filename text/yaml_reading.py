"""YAML to a tree with positions, built from PyYAML's events, so memory stays bounded.

Profiles, messages and parameters are all read here, each by its own rules, so the same mistake
gets the same message everywhere. Depth is bounded, no tag constructs anything; where aliases are
allowed, they share branches and are counted as if written out.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, TypeAlias

import yaml

from text.sentences import say
from text.yaml_faults import YamlError, events, fault, not_as_it_seems, space_meant, space_missing, wide_colon
from text.yaml_scalars import meaning
from text.yaml_tree import Branch, FilePlace, Listing, MappingEntry, Scalar, empty

if TYPE_CHECKING:
    from text.yaml_tree import Tree, Where

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
_MERGE = "<<"


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
    builder = _Builder(rules, file, tell or _raised)
    for event in events(text):
        builder.take(event)
    return builder.root


def mapping(tree: Tree) -> Branch:
    """Return a tree that has to be a mapping. Raises YamlError."""
    if isinstance(tree, Branch):
        return tree
    check_colons(tree)
    kind = say("a list") if isinstance(tree, Listing) else say("a single value")
    if empty(tree):
        kind = say("nothing")
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


@dataclass(slots=True)
class _Open:
    """A mapping or a list that has not ended yet."""

    place: FilePlace
    anchor: str | None
    is_mapping: bool
    items: list[Tree] = field(default_factory=list)
    entries: dict[str, MappingEntry] = field(default_factory=dict)
    merged: list[Branch] = field(default_factory=list)
    key: Scalar | None = None
    merges: bool = False
    """Whether the key is `<<`, without quotes."""
    size: int = 1


class _Builder:
    """Takes events, builds the tree."""

    def __init__(self, rules: Rules, file: str, tell: Tell) -> None:
        self.root: Tree | None = None
        self._rules, self._file, self._tell = rules, file, tell
        self._stack: list[_Open] = []
        self._anchors: dict[str, Tree] = {}

    def take(self, event: yaml.Event) -> None:
        if isinstance(event, yaml.ScalarEvent):
            merges = not event.style and event.value == _MERGE
            self._put(self._scalar(event), merges=merges and self._rules.shares)
        elif isinstance(event, yaml.CollectionStartEvent):
            self._open(event)
        elif isinstance(event, yaml.CollectionEndEvent):
            opened = self._stack.pop()
            tree = _closed(opened)
            self._remember(opened.anchor, tree)
            self._put(tree)
        elif isinstance(event, yaml.AliasEvent):
            self._put(self._alias(event))
        elif isinstance(event, yaml.DocumentStartEvent) and self.root is not None:
            words = say("a second document begins here, and only one is read")
            raise fault(self._place(event), words)

    def _open(self, event: yaml.CollectionStartEvent) -> None:
        place = self._place(event)
        is_mapping = isinstance(event, yaml.MappingStartEvent)
        self._check(event, place, fits=event.tag == f"{TAG}{'map' if is_mapping else 'seq'}")
        if len(self._stack) >= self._rules.deepest:
            limit = self._rules.deepest
            raise fault(place, say("is nested deeper than {limit} levels", limit=limit))
        self._stack.append(_Open(place, event.anchor, is_mapping))

    def _scalar(self, event: yaml.ScalarEvent) -> Scalar:
        place = self._place(event)
        self._check(event, place, fits=event.tag in _KINDS)
        top = self._stack[-1] if self._stack else None
        # Keys are words, `on` and `y` too.
        is_key = top is not None and top.is_mapping and top.key is None and not event.anchor
        if not event.style:
            odd = space_meant(event.value, is_name=is_key)
            if odd is not None:
                raise not_as_it_seems(place.line, place.column + odd, event.value[odd])
        is_text = is_key or (event.style and event.tag is None) or event.tag == "!"
        value = event.value if is_text else self._value(event, place)
        scalar = Scalar(value, event.value, place)
        self._remember(event.anchor, scalar)
        return scalar

    def _value(self, event: yaml.ScalarEvent, place: FilePlace) -> bool | int | float | str | None:
        if event.tag == f"{TAG}str":
            text: str = event.value
            return text
        value = meaning(event.value)
        if event.tag is None:
            return value
        wanted = _KINDS[event.tag]
        if wanted is float and type(value) is int and abs(value) <= sys.float_info.max:
            value = float(value)
        if type(value) is wanted:
            return value
        kind = event.tag.removeprefix(TAG)
        words = say("{text!r} is not a valid {kind}", text=event.value[:40], kind=kind)
        self._tell(fault(place, words))
        return None

    def _alias(self, event: yaml.AliasEvent) -> Tree:
        name = str(event.anchor)
        place = self._place(event)
        if not self._rules.shares:
            raise fault(place, say("aliases are refused: write the value out"))
        if any(opened.anchor == name for opened in self._stack):
            raise fault(place, say("*{name} contains itself", name=name))
        if name not in self._anchors:
            words = say("*{name} refers to nothing: there is no &{name} before it", name=name)
            raise fault(place, words)
        return replace(self._anchors[name], place=place)

    def _put(self, tree: Tree, *, merges: bool = False) -> None:
        """Put a finished value where it belongs: the root, a list, a key or a key's value."""
        if not self._stack:
            self.root = tree
            return
        top = self._stack[-1]
        top.size += tree.size
        if top.size > self._rules.most:
            words = say("has more than {limit} values, counting aliases", limit=self._rules.most)
            raise fault(tree.place, words)
        if not top.is_mapping:
            top.items.append(tree)
        elif top.key is None:
            if not isinstance(tree, Scalar):
                words = say("expected a name before the ':', found a list or a mapping")
                raise fault(tree.place, words)
            top.key, top.merges = tree, merges
        else:
            self._put_entry(top, top.key, tree)
            top.key = None

    def _put_entry(self, top: _Open, key: Scalar, value: Tree) -> None:
        if top.merges:
            sources = value.items if isinstance(value, Listing) else (value,)
            top.merged += [source for source in sources if isinstance(source, Branch)]
            if not all(isinstance(source, Branch) for source in sources):
                words = say("expected a mapping to merge")
                self._tell(fault(key.place, words, self._where(key.text)))
        elif self._rules.joins:
            there = top.entries.get(key.text)
            value = value if there is None else _joined(there.value, value)
            top.entries[key.text] = MappingEntry(there.key_place if there else key.place, value)
        elif key.text in top.entries:
            words = say(
                "{name} appears a second time, first on line {line}: join them or rename one",
                name=repr(key.text),
                line=top.entries[key.text].key_place.line,
            )
            self._tell(fault(key.place, words, self._where(key.text)))
        else:
            top.entries[key.text] = MappingEntry(key.place, value)

    def _where(self, name: str) -> Where:
        """Return the path of a key of the mapping that is being read."""
        outer = (each.key.text if each.key else len(each.items) for each in self._stack[:-1])
        return (*outer, name)

    def _remember(self, anchor: str | None, tree: Tree) -> None:
        if anchor is not None:
            self._anchors[anchor] = tree

    def _check(self, event: yaml.ScalarEvent | yaml.CollectionStartEvent, place: FilePlace, *, fits: bool) -> None:
        """Refuse an anchor where none is allowed, and a tag that does not fit."""
        if event.anchor is not None and not self._rules.shares:
            raise fault(place, say("anchors are refused: write the value out"))
        if event.tag not in (None, "!") and not fits:
            tag = event.tag.replace(TAG, "!!")
            words = say("the tag {tag} is refused: only plain values are read", tag=tag)
            raise fault(place, words)

    def _place(self, event: yaml.Event) -> FilePlace:
        mark = event.start_mark
        assert mark is not None  # Events that a text was parsed to have one.
        return FilePlace(self._file, mark.line + 1, mark.column + 1)


def _joined(first: Tree, again: Tree) -> Tree:
    if not isinstance(first, Branch) or not isinstance(again, Branch):
        return again
    entries = dict(first.entries)
    for name, entry in again.entries.items():
        there = entries.get(name)
        value = entry.value if there is None else _joined(there.value, entry.value)
        entries[name] = MappingEntry(entry.key_place, value)
    return Branch(entries, first.place, first.size + again.size)


def _closed(opened: _Open) -> Tree:
    if not opened.is_mapping:
        return Listing(tuple(opened.items), opened.place, opened.size)
    entries = opened.entries
    for source in opened.merged:
        for name, entry in source.entries.items():
            entries.setdefault(name, entry)
    return Branch(entries, opened.place, opened.size)
