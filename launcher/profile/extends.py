"""`extends:` - a profile that only states its differences from another one.

Mappings are merged key by key, down to single parameters; everything else replaces the value in the
other profile. A node set to null is removed, and `run` replaces `exec` and vice versa.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from launcher.profile.field_marks import Joined, marked
from launcher.profile.files import with_own_files
from launcher.profile.model import NodeDocument, ProfileDocument
from launcher.profile.reading import read_yaml
from launcher.profile.text import SHIPPED, read_text, shown
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import Branch, MappingEntry, empty, plain

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from launcher.profile.problems import Problems

ALL: Any = {}
ALL["*"] = ALL
JOINED: Any = {
    "nodes": {"*": dict.fromkeys(marked(NodeDocument, Joined), ALL)},
    **dict.fromkeys(marked(ProfileDocument, Joined), ALL),
}
"""The mappings that are merged, by their keys; `*` stands for any key."""
MAX_CHAIN = 32
"""Longest chain of profiles that extend one another; nobody can follow a longer one."""
RIVALS = {"run": "exec", "exec": "run"}


def read_profile(path: Path, problems: Problems) -> Branch | None:
    """Return the profile merged with those it extends; None and problems if one is unreadable."""
    return _read(path, problems, ())


def _read(path: Path, problems: Problems, chain: tuple[Path, ...]) -> Branch | None:
    text = read_text(path, problems)
    written = None if text is None else read_yaml(text, shown(path), problems)
    tree = None if written is None else with_own_files(written, path.parent)
    if tree is None or "extends" not in tree.entries:
        return tree
    entry = tree.entries["extends"]
    own = Branch({key: value for key, value in tree.entries.items() if key != "extends"}, tree.place)
    wanted = plain(entry.value)
    if not isinstance(wanted, str):
        problems.add(entry.value.place, ("extends",), say("expected the name of a profile"))
        return own
    base_path = _base_path(wanted, path)
    seen = (*chain, path.resolve())
    if base_path is None:
        message = say("there is no profile {name!r} to extend", name=wanted)
        hint = did_you_mean(wanted, _extendable(path, seen))
        problems.add(entry.value.place, ("extends",), message, hint)
        return own
    if base_path.resolve() in seen:
        names = [each.stem for each in seen[seen.index(base_path.resolve()) :]]
        cycle = " -> ".join([*names, base_path.stem])
        message = say("profiles extend each other in a cycle: {cycle}", cycle=cycle)
        problems.add(entry.value.place, ("extends",), message)
        return own
    if len(seen) == MAX_CHAIN:
        message = say("more than {most} profiles extend each other in a row", most=MAX_CHAIN)
        hint = say("merge some of them into one profile")
        problems.add(entry.value.place, ("extends",), message, hint)
        return own
    base = _read(base_path, problems, seen)
    return own if base is None else _without_removed(_joined(base, own))


def _base_path(wanted: str, path: Path) -> Path | None:
    """Find the profile: a path relative to this file, else a name next to it or in the course."""
    beside = path.parent / wanted
    # Joined as text: `/` and `..` have no name to which a suffix could be added.
    candidates = [beside, Path(f"{beside}.yaml"), SHIPPED / f"{wanted}.yaml"]
    try:
        return next((candidate for candidate in candidates if candidate.is_file()), None)
    except (OSError, ValueError):
        return None


def _extendable(path: Path, seen: Collection[Path]) -> Iterator[str]:
    """Yield the names of profiles that this file may extend without a cycle."""
    for other in (*path.parent.glob("*.yaml"), *SHIPPED.glob("*.yaml")):
        found = _base_path(other.stem, path)
        if found is not None and found.resolve() not in seen:
            yield other.stem


def _joined(base: Branch, own: Branch, joined: Any = JOINED) -> Branch:  # noqa: ANN401 - nested
    entries = dict(base.entries)
    for key, entry in own.entries.items():
        below = entries[key].value if key in entries else None
        inner = joined.get(key, joined.get("*"))
        if inner is not None and isinstance(below, Branch) and isinstance(entry.value, Branch):
            entries[key] = MappingEntry(entry.key_place, _joined(below, entry.value, inner))
        else:
            entries.pop(RIVALS.get(key, ""), None)
            entries[key] = entry
    return Branch(entries, own.place)


def _without_removed(tree: Branch) -> Branch:
    nodes = tree.entries.get("nodes")
    if nodes is None or not isinstance(nodes.value, Branch):
        return tree
    kept: dict[str, MappingEntry] = {
        name: entry for name, entry in nodes.value.entries.items() if not empty(entry.value)
    }
    entries = dict(tree.entries)
    entries["nodes"] = MappingEntry(nodes.key_place, Branch(kept, nodes.value.place))
    return Branch(entries, tree.place)
