"""Looking a Python module up without importing it, or anything on the way to it."""

from __future__ import annotations

import os
import pkgutil
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from importlib.machinery import ModuleSpec

COURSE = "nodes"
"""The package of the lessons' own nodes."""


def find_folder(module: str, folders: Sequence[Path]) -> Path | None:
    """Return where `python -m MODULE` has to look; None if nowhere has it.

    Python's own path goes first, and counts as the empty path: nothing has to be added to it.
    Whatever the current directory happens to be is not Python's own path: a node may run in
    another.
    """
    own = [entry for entry in sys.path if entry and Path(entry) != Path.cwd()]
    if _runnable(module, own):
        return Path()
    return next((folder for folder in folders if _runnable(module, [str(folder)])), None)


def likely_names(module: str, folders: Sequence[Path]) -> list[str]:
    """Return modules that may have been meant: those beside it, and the course's nodes."""
    places = [*map(str, folders), *(entry or os.curdir for entry in sys.path)]
    package, _, _ = module.rpartition(".")
    names = _inside(map(str, folders))
    for parent in {package, COURSE} - {""}:
        spec = _find(parent, places)
        inner = spec.submodule_search_locations if spec is not None else None
        names += [f"{parent}.{name}" for name in _inside(inner or ())]
    return names


def _inside(places: Iterable[str]) -> list[str]:
    found = (module.name for module in pkgutil.iter_modules(list(places)))
    return [name for name in found if not name.startswith("_")]


def _runnable(module: str, places: Sequence[str]) -> bool:
    spec = _find(module, places)
    if spec is None or spec.submodule_search_locations is None:
        return spec is not None
    return _find_in(f"{module}.__main__", list(spec.submodule_search_locations)) is not None


def _find(module: str, places: Sequence[str]) -> ModuleSpec | None:
    """Find a module part by part: `find_spec` of the whole name would import its packages."""
    name, spec = "", None
    inner = list(places)
    for part in module.split("."):
        name = f"{name}.{part}" if name else part
        spec = _find_in(name, inner)
        if spec is None:
            return None
        inner = list(spec.submodule_search_locations or ())
    return spec


def _find_in(name: str, places: list[str]) -> ModuleSpec | None:
    for finder in sys.meta_path:
        find_spec = getattr(finder, "find_spec", None)
        # Only the finder of paths is told where; those of editable installs know by themselves.
        where = places if finder is PathFinder or "." in name else None
        try:
            spec: ModuleSpec | None = find_spec(name, where) if find_spec else None
        except (ImportError, ValueError, OSError):
            continue
        if spec is not None:
            return spec
    return None
