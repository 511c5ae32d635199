"""The user's own nodes, `run: ./my_sonar.py`, and folders: relative to the profile's file."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from launcher.profile.field_marks import PathFromProfile, marked
from launcher.profile.model import NodeDocument
from text.yaml_tree import Branch, MappingEntry, Scalar

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from text.yaml_tree import Tree


PATHS = marked(NodeDocument, PathFromProfile)


def with_own_files(profile: Branch, folder: Path) -> Branch:
    """Return a profile from this folder with the paths in its nodes made absolute."""
    nodes = profile.entries.get("nodes")
    if nodes is None or not isinstance(nodes.value, Branch):
        return profile
    found = {
        name: MappingEntry(node.key_place, _with_full_paths(node.value, folder))
        for name, node in nodes.value.entries.items()
    }
    every = MappingEntry(nodes.key_place, Branch(found, nodes.value.place))
    return Branch({**profile.entries, "nodes": every}, profile.place)


def _with_full_paths(node: Tree, folder: Path) -> Tree:
    if not isinstance(node, Branch):
        return node
    parts = {key: _with_full_path(key, part, folder) for key, part in node.entries.items()}
    return Branch(parts, node.place)


def _with_full_path(key: str, part: MappingEntry, folder: Path) -> MappingEntry:
    written = part.value
    if not isinstance(written, Scalar) or not isinstance(written.value, str):
        return part
    if key not in PATHS or not PATHS[key].is_meant(written.value):
        return part
    path = os.path.normpath(folder.absolute() / written.value)
    return MappingEntry(part.key_place, Scalar(path, written.text, written.place))


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
