"""Nodes of the user's own: `run: ./my_sonar.py`, a path relative to the profile that says so."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from launcher.profile_tree import Branch, Entry, Scalar

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from launcher.profile_tree import Tree


def is_file(run: str) -> bool:
    """Whether a file is meant, and not a module."""
    return run.startswith(("./", "../", "/"))


def with_own_files(profile: Branch, folder: Path) -> Branch:
    """Return a profile, of this folder, with the files of its nodes by their full paths."""
    nodes = profile.entries.get("nodes")
    if nodes is None or not isinstance(nodes.value, Branch):
        return profile
    found = {
        name: Entry(node.key_place, _with_own_file(node.value, folder))
        for name, node in nodes.value.entries.items()
    }
    every = Entry(nodes.key_place, Branch(found, nodes.value.place, nodes.value.size))
    return Branch({**profile.entries, "nodes": every}, profile.place, profile.size)


def _with_own_file(node: Tree, folder: Path) -> Tree:
    run = node.entries.get("run") if isinstance(node, Branch) else None
    if not isinstance(node, Branch) or run is None or not isinstance(run.value, Scalar):
        return node
    written = run.value
    if not isinstance(written.value, str) or not is_file(written.value):
        return node
    path = os.path.normpath(folder.absolute() / written.value)
    value = Scalar(path, written.text, written.place, written.size)
    return Branch({**node.entries, "run": Entry(run.key_place, value)}, node.place, node.size)


def files_beside(folder: Path) -> list[str]:
    """Return the Python files of a folder, as `run` names them."""
    try:
        return [f"./{path.name}" for path in sorted(folder.glob("*.py"))]
    except (OSError, ValueError):
        return []


def file_of(module: str, folders: Sequence[Path], profile_folder: Path) -> str:
    """Return the file that a module would be in one of these folders, as `run` names it."""
    for folder in folders:
        path = folder / f"{module.replace('.', '/')}.py"
        if path.is_file():
            found = os.path.relpath(path, profile_folder)
            return found if found.startswith("../") else f"./{found}"
    return ""
