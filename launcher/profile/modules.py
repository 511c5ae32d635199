"""Looking up a Python module without importing it or any of its parent packages."""

from __future__ import annotations

import os
import pkgutil
import sys
from importlib.machinery import PathFinder
from typing import TYPE_CHECKING

from launcher.node_program import INSTALLATION

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from importlib.machinery import ModuleSpec

COURSE = "nodes"
"""The package of the course's nodes."""


def is_installed(module: str) -> bool:
    """Whether a node can run this module, that is, `launcher.node_program` finds it."""
    return _runnable(module, _places())


def likely_names(module: str) -> list[str]:
    """Return modules that may have been meant: those of the same package, and the course's."""
    package, _, _ = module.rpartition(".")
    names = []
    for parent in {package, COURSE} - {""}:
        spec = _find(parent, _places())
        inner = spec.submodule_search_locations if spec is not None else None
        names += [f"{parent}.{name}" for name in _inside(inner or ())]
    return names


def _places() -> list[str]:
    """The search path of a node's Python: without the current folder, unless PYTHONPATH has it."""
    here = os.getcwd()  # noqa: PTH109
    named = [part for part in os.environ.get("PYTHONPATH", "").split(os.pathsep) if part]
    others = (place for place in sys.path if place and place != here)
    return [INSTALLATION, *map(os.path.abspath, named), *others]


def _inside(places: Iterable[str]) -> list[str]:
    found = (module.name for module in pkgutil.iter_modules(list(places)))
    return [name for name in found if not name.startswith("_")]


def _runnable(module: str, places: Sequence[str]) -> bool:
    spec = _find(module, places)
    if spec is None or spec.submodule_search_locations is None:
        return spec is not None
    return _find_in(f"{module}.__main__", list(spec.submodule_search_locations)) is not None


def _find(module: str, places: Sequence[str]) -> ModuleSpec | None:
    """Find a module part by part: `find_spec` on the whole name would import its packages."""
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
        # Only the path finder is given the places; those of editable installs have their own.
        where = places if finder is PathFinder or "." in name else None
        try:
            spec: ModuleSpec | None = find_spec(name, where) if find_spec else None
        except (ImportError, ValueError, OSError):
            continue
        if spec is not None:
            return spec
    return None
