"""`${devices.pico.port}`, `${run_dir}`, `${domain}`: filling in the values of these references."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from launcher.profile.when import WhenError, holds
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import Branch, Listing, MappingEntry, Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from launcher.profile.problems import Problems
    from text.yaml_tree import Tree, Where

DEVICE = re.compile(r"\$\{devices\.([^}]*)\}")
PLACE = re.compile(r"\$\{(\w+)\}")
REFERRING = ("params", "exec", "env")
"""The parts of a node in which references are filled in."""


class Filler:
    """Fills in values; an unknown name in `${}` is left as it is."""

    def __init__(self, settings: Mapping[str, Scalar], places: Mapping[str, str], problems: Problems) -> None:
        """`settings`: {"pico.port": ...}; `places`: {"run_dir": ...}."""
        self._settings, self._places, self._problems = settings, places, problems

    def nodes(self, nodes: Branch) -> Branch:
        """Return all nodes with everything filled in."""
        filled = {
            name: MappingEntry(entry.key_place, self._node(name, entry.value))
            for name, entry in nodes.entries.items()
        }
        return Branch(filled, nodes.place)

    def branch(self, branch: Branch, where: Where) -> Branch:
        """Return a branch with everything filled in."""
        filled = {
            key: MappingEntry(entry.key_place, self._tree(entry.value, (*where, key)))
            for key, entry in branch.entries.items()
        }
        return Branch(filled, branch.place)

    def _node(self, name: str, node: Tree) -> Tree:
        if not isinstance(node, Branch):
            return node
        parts = {
            key: MappingEntry(part.key_place, self._tree(part.value, ("nodes", name, key)))
            if key in REFERRING
            else part
            for key, part in node.entries.items()
        }
        return Branch(parts, node.place)

    def _tree(self, tree: Tree, where: Where) -> Tree:
        if isinstance(tree, Branch):
            return self.branch(tree, where)
        if isinstance(tree, Listing):
            items = (self._tree(item, (*where, index)) for index, item in enumerate(tree.items))
            return Listing(tuple(items), tree.place)
        if not isinstance(tree.value, str) or "${" not in tree.value:
            return tree
        return self._text(tree, where)

    def _text(self, scalar: Scalar, where: Where) -> Scalar:
        text = PLACE.sub(lambda match: self._places.get(match[1], match[0]), scalar.text)
        for name in DEVICE.findall(text):
            if name not in self._settings:
                self._unknown(name, scalar, where)
                return scalar
        whole = DEVICE.fullmatch(text)
        if whole:
            found = self._settings[whole[1]]
            return Scalar(found.value, found.text, scalar.place)
        if text == scalar.text and not DEVICE.search(text):
            return scalar
        filled = DEVICE.sub(lambda match: self._settings[match[1]].text, text)
        return Scalar(filled, filled, scalar.place)

    def _unknown(self, name: str, scalar: Scalar, where: Where) -> None:
        message = say("there is no device setting {name!r}", name=name)
        known = say("known: {keys}", keys=", ".join(self._settings))
        hint = did_you_mean(name, self._settings) or known
        self._problems.add(scalar.place, where, message, hint if self._settings else "")


def used_devices(tree: Branch, hardware: str) -> set[str]:
    """Return the devices that are referred to by nodes which run on this hardware."""
    nodes = tree.entries.get("nodes")
    if nodes is None or not isinstance(nodes.value, Branch):
        return set()
    return {
        match[1].partition(".")[0]
        for entry in nodes.value.entries.values()
        if isinstance(entry.value, Branch) and _runs(entry.value, hardware)
        for key in REFERRING
        if key in entry.value.entries
        for text in _texts(entry.value.entries[key].value)
        for match in DEVICE.finditer(text)
    }


def _runs(node: Branch, hardware: str) -> bool:
    when = node.entries.get("when")
    if when is None or not isinstance(when.value, Scalar) or not isinstance(when.value.value, str):
        return True
    try:
        return holds(when.value.value, {"hardware": hardware})
    except WhenError:
        return True  # Its fault is reported elsewhere.


def _texts(tree: Tree) -> Iterator[str]:
    if isinstance(tree, Branch):
        for entry in tree.entries.values():
            yield from _texts(entry.value)
    elif isinstance(tree, Listing):
        for item in tree.items:
            yield from _texts(item)
    elif isinstance(tree.value, str):
        yield tree.value
