"""Modules that many nodes of a project share, imported once for all of them.

A package names them itself: `__preload__ = ("_life", "_topics")` in its `__init__.py`. They are
the user's to edit at any time, so a node that is forked later looks whether they are still as
they were, and imports them anew if not.
"""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import os
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import ModuleType

_Stamp = tuple[str, int, int]
"""File, time of its last change in nanoseconds, size."""


class SharedModules:
    """What has been imported of the project's own packages."""

    def __init__(self) -> None:
        self._packages: dict[str, dict[str, _Stamp]] = {}

    def load(self, package: str) -> Iterator[str]:
        """Import what `package` names, step by step; leave out what does not go."""
        before = set(sys.modules)
        with contextlib.suppress(Exception):
            names = getattr(importlib.import_module(package), "__preload__", ())
            for name in names:
                importlib.import_module(f"{package}.{name}")
                yield name
        self._packages[package] = {
            name: _stamp(sys.modules[name])
            for name in set(sys.modules) - before
            if _is_project(sys.modules[name])
        }

    def renew(self, module: str) -> None:
        """In a forked node: drop what is no longer as it was imported.

        The `__init__` of the package that `module`, the node's own, is in runs again: it may look
        at the command line.
        """
        for package, stamps in self._packages.items():
            if package not in sys.modules:
                continue
            if _elsewhere(package) or any(_changed(stamp) for stamp in stamps.values()):
                for name in stamps:
                    sys.modules.pop(name, None)
            elif module.startswith(f"{package}."):
                importlib.reload(sys.modules[package])


def _is_project(module: ModuleType) -> bool:
    file = getattr(module, "__file__", None) or ""
    return file.endswith(".py") and "site-packages" not in file and not file.startswith(_STDLIB)


_STDLIB = os.path.dirname(os.__file__)  # noqa: PTH120 - compared as text


def _stamp(module: ModuleType) -> _Stamp:
    file = str(module.__file__)
    status = os.stat(file)  # noqa: PTH116
    return file, status.st_mtime_ns, status.st_size


def _changed(stamp: _Stamp) -> bool:
    try:
        status = os.stat(stamp[0])  # noqa: PTH116
    except OSError:
        return True
    return stamp[1:] != (status.st_mtime_ns, status.st_size)


def _elsewhere(package: str) -> bool:
    """Whether Python, with this node's path, would find another package of that name."""
    loaded = sys.modules.pop(package)
    try:
        spec = importlib.util.find_spec(package)
    except (ImportError, ValueError):
        spec = None
    finally:
        sys.modules[package] = loaded
    return spec is None or spec.origin != loaded.__file__
