"""Reading the files of a profile, that of the profile it extends among them, and collecting problems.

With `extends:` a profile only states its differences from another one: mappings are merged key by
key, down to single parameters; everything else replaces the value in the other profile. A node set to
null is removed, and `run` replaces `exec` and vice versa. Paths are relative to the file they are in.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from launcher.errors import ProfileProblem
from launcher.parts import Joined, PathFromProfile, marked
from launcher.profile.defaults import SHIPPED, shown
from launcher.profile.model import Profile
from launcher.profile.node import Node
from text.os_words import os_reason
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_faults import YamlError
from text.yaml_tree import (
    Branch,
    FilePlace,
    MappingEntry,
    Rules,
    Scalar,
    Tree,
    Where,
    check_colons,
    empty,
    field_name,
    mapping,
    place_of,
    plain,
    read,
)

MAX_BYTES = 256 * 1024
RULES = Rules(shares=True, longest=MAX_BYTES, deepest=24, most=20_000)
MAX_CHAIN = 32
"""Longest chain of profiles that extend one another; nobody can follow a longer one."""
RIVALS = {"run": "exec", "exec": "run"}
PATHS = marked(Node, PathFromProfile)
ALL: Any = {}
ALL["*"] = ALL
JOINED: Any = {
    "nodes": {"*": dict.fromkeys(marked(Node, Joined), ALL)},
    **dict.fromkeys(marked(Profile, Joined), ALL),
}
"""The mappings that are merged, by their keys; `*` stands for any key."""


@dataclass
class Problems:
    """Collects problems, so that all can be reported at once."""

    found: list[ProfileProblem] = field(default_factory=list)
    tree: Branch = field(default_factory=lambda: Branch({}, FilePlace("")))
    """The profile that `at` speaks of."""

    def add(self, place: FilePlace, where: Where, message: str, hint: str = "") -> None:
        """Add a problem; duplicates count once."""
        problem = ProfileProblem(place.file, place.line, place.column, field_name(where), message, hint)
        if problem not in self.found:
            self.found.append(problem)

    def at(self, where: Where, message: str, hint: str = "", *, key: bool = False) -> None:
        """Add a problem of the value at this path of the profile, or of its key."""
        self.add(place_of(self.tree, where, key=key), where, message, hint)

    def take(self, file: str, error: YamlError) -> None:
        """Add an error in the YAML of a file."""
        self.add(FilePlace(file, error.line, error.column), error.where, error.message)

    def in_order(self) -> tuple[ProfileProblem, ...]:
        """Return the problems ordered by file and line."""
        return tuple(sorted(self.found, key=lambda each: (each.file, each.line, each.column)))


def read_value(text: str, file: str, problems: Problems) -> Tree | None:
    """Return the value that a piece of YAML stands for, as of `--set`; None and a problem else."""
    try:
        return read(text, RULES, file, partial(problems.take, file)) or Scalar("", "", FilePlace(file))
    except YamlError as error:
        problems.take(file, error)
        return None


def read_yaml(text: str, file: str, problems: Problems) -> Branch | None:
    """Return the only document of `text`, a mapping, or None and problems that say why not."""
    try:
        root = read(text, RULES, file, partial(problems.take, file))
        if root is not None and not empty(root):
            check_colons(root)
            return mapping(root)
    except YamlError as error:
        problems.take(file, error)
        return None
    problems.add(FilePlace(file, 1, 1), (), say("is empty"), say("a profile has at least `nodes:`"))
    return None


def read_profile(path: Path, problems: Problems, chain: tuple[Path, ...] = ()) -> Branch | None:
    """Return the profile merged with those it extends; None and problems if one is unreadable.

    `chain`: those that extend it.
    """
    text = _read_text(path, problems)
    written = None if text is None else read_yaml(text, shown(path), problems)
    tree = None if written is None else _with_full_paths(written, path.parent)
    if tree is None or "extends" not in tree.entries:
        return tree
    told, wanted = tree.entries["extends"].value.place, plain(tree.entries["extends"].value)
    own = Branch({key: value for key, value in tree.entries.items() if key != "extends"}, tree.place)
    if not isinstance(wanted, str):
        problems.add(told, ("extends",), say("expected the name of a profile"))
        return own
    base_path = _base_path(wanted, path)
    seen = (*chain, path.resolve())
    if base_path is None:
        message = say("there is no profile {name!r} to extend", name=wanted)
        problems.add(told, ("extends",), message, did_you_mean(wanted, _extendable(path, seen)))
        return own
    if base_path.resolve() in seen:
        names = [each.stem for each in seen[seen.index(base_path.resolve()) :]]
        cycle = " -> ".join([*names, base_path.stem])
        problems.add(told, ("extends",), say("profiles extend each other in a cycle: {cycle}", cycle=cycle))
        return own
    if len(seen) == MAX_CHAIN:
        message = say("more than {most} profiles extend each other in a row", most=MAX_CHAIN)
        problems.add(told, ("extends",), message, say("merge some of them into one profile"))
        return own
    base = read_profile(base_path, problems, seen)
    return own if base is None else _without_removed(_joined(base, own))


def _read_text(path: Path, problems: Problems) -> str | None:
    """Return the text of a profile, a small regular UTF-8 file, or None and a problem."""
    place = FilePlace(shown(path))
    try:
        # Opening a pipe or a terminal could block: check the type of file first.
        mode = path.stat().st_mode
        if not stat.S_ISREG(mode):
            kind = say("a directory") if stat.S_ISDIR(mode) else say("not a regular file")
            problems.add(place, (), say("expected a YAML file, found {kind}", kind=kind), _inside(path))
            return None
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
        if len(data) <= MAX_BYTES:
            return data.decode("utf-8-sig")
        limit = MAX_BYTES // 1024
        problems.add(place, (), say("is larger than {limit} KiB: too large for a profile", limit=limit))
    except FileNotFoundError:
        problems.add(place, (), say("no such file"), say("`deck list` shows all profiles"))
    except PermissionError:
        problems.add(place, (), say("no permission to read it"), say("chmod u+r it, or ask its owner"))
    except OSError as error:
        problems.add(place, (), say("cannot be read: {reason}", reason=os_reason(error)))
    except UnicodeDecodeError as error:
        *above, before = data[: error.start].split(b"\n")
        at = FilePlace(place.file, len(above) + 1, len(before.decode("utf-8", "replace")) + 1)
        message = say("is not UTF-8: byte 0x{byte:02x}", byte=data[error.start])
        problems.add(at, (), message, say("save the file as UTF-8"))
    return None


def _inside(path: Path) -> str:
    """Return a hint that lists the profiles in the directory, if it has any."""
    if not path.is_dir() or not os.access(path, os.R_OK | os.X_OK):
        return ""
    names = sorted(child.name for child in path.glob("*.yaml"))[:5]
    return say("it contains: {names}", names=", ".join(names)) if names else ""


def _with_full_paths(profile: Branch, folder: Path) -> Branch:
    """Return a profile from this folder with the paths in its nodes made absolute."""
    nodes = profile.entries.get("nodes")
    if nodes is None or not isinstance(nodes.value, Branch):
        return profile
    for name, node in nodes.value.entries.items():
        for key, part in node.value.entries.items() if isinstance(node.value, Branch) else ():
            written = part.value
            if key not in PATHS or not isinstance(written, Scalar) or not isinstance(written.value, str):
                continue
            if PATHS[key].is_meant(written.value):
                path = os.path.normpath(folder.absolute() / written.value)
                profile = replaced(profile, ("nodes", name, key), Scalar(path, written.text, written.place))
    return profile


def replaced(branch: Branch, where: tuple[str, ...], value: Tree) -> Branch:
    """Return a mapping in which the value at this path, where there is one, is another."""
    key, *below = where
    entry = branch.entries[key]
    if below:
        assert isinstance(entry.value, Branch)
        value = replaced(entry.value, tuple(below), value)
    return Branch({**branch.entries, key: MappingEntry(entry.key_place, value)}, branch.place)


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


def _joined(base: Branch, own: Branch, joined: Mapping[str, Any] = JOINED) -> Branch:
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
    kept = {name: entry for name, entry in nodes.value.entries.items() if not empty(entry.value)}
    return replaced(tree, ("nodes",), Branch(kept, nodes.value.place))


def files_beside(folder: Path) -> list[str]:
    """Return the Python files of a folder, in the form used by `run`."""
    try:
        return [f"./{path.name}" for path in sorted(folder.glob("*.py"))]
    except (OSError, ValueError):
        return []


def file_of(module: str, folders: Sequence[Path], profile_folder: Path) -> str:
    """Return the file of a module in one of these folders, in the form used by `run`."""
    for folder in folders:
        path = folder / f"{module.replace('.', '/')}.py"
        if path.is_file():
            found = os.path.relpath(path, profile_folder)
            return found if found.startswith("../") else f"./{found}"
    return ""
