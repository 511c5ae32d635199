"""Modules that many nodes of a project share, imported once for all of them.

A package lists them in its `__init__.py`: in `__preload__ = ("._life", "_topics")` those that nearly every node
needs, in `__preload_idle__` those that some need, imported when there is time; a leading dot means a module of the
package itself. The user may edit them at any time, so a node that is forked later checks whether they are unchanged,
and imports them again if not.
"""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import os
import sys
from typing import TYPE_CHECKING

from launcher.node_program import INSTALLATION, is_ours

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import ModuleType

_Stamp = tuple[str, int, int]
"""A file, its modification time in nanoseconds, and its size."""


class SharedModules:
    """The modules of the project's packages that have been imported."""

    def __init__(self) -> None:
        self._packages: dict[str, dict[str, _Stamp]] = {}

    def load(self, package: str) -> Iterator[str]:
        """Import, step by step, the modules that `package` lists for nearly every node."""
        return self._load(package, "__preload__")

    def load_idly(self, package: str) -> Iterator[str]:
        """Import, step by step, the modules that `package` lists for some nodes."""
        return self._load(package, "__preload_idle__")

    def _load(self, package: str, attribute: str) -> Iterator[str]:
        stamps = self._packages.setdefault(package, {})
        with contextlib.suppress(Exception):
            with _noting(stamps):
                loaded = importlib.import_module(package)
            for name in getattr(loaded, attribute, ()):
                with _noting(stamps):
                    importlib.import_module(name, package)
                yield name

    def renew(self, module: str) -> None:
        """In a forked node: drop modules that have changed since they were imported.

        The `__init__` of the package of `module`, the node's own module, runs again, because it may
        look at the command line. A node that is not Deck's may mean another package of that name.
        """
        if not is_ours(module):
            for package in _packages_of_deck():
                if _elsewhere(package):
                    _forget(package)
        for package, stamps in self._packages.items():
            if package not in sys.modules:
                continue
            if _elsewhere(package) or any(_changed(stamp) for stamp in stamps.values()):
                for name in stamps:
                    sys.modules.pop(name, None)
            elif module.startswith(f"{package}."):
                importlib.reload(sys.modules[package])


def _packages_of_deck() -> list[str]:
    """Return the packages that have been imported here, for whatever reason."""
    return [
        name
        for name in os.listdir(INSTALLATION)  # noqa: PTH208
        if str(getattr(sys.modules.get(name), "__file__", "")).startswith(f"{INSTALLATION}/{name}/")
    ]


def _forget(package: str) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == package]:
        del sys.modules[name]


@contextlib.contextmanager
def _noting(stamps: dict[str, _Stamp]) -> Iterator[None]:
    """Record the state of the project's modules imported meanwhile, even if the last one fails."""
    before = set(sys.modules)
    try:
        yield
    finally:
        for name in set(sys.modules) - before:
            if _is_project(sys.modules[name]):
                stamps[name] = _stamp(sys.modules[name])


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
    """Whether Python, with this node's path, finds another package of that name."""
    loaded = sys.modules.pop(package)
    try:
        spec = importlib.util.find_spec(package)
    except (ImportError, ValueError):
        spec = None
    finally:
        sys.modules[package] = loaded
    return spec is None or spec.origin != loaded.__file__
