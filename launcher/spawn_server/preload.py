"""The imports that the spawn server makes before it forks nodes, so that they need not.

It creates no context, node or thread: a fork copies only the thread that forks.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import importlib
import inspect
import os
import warnings
from itertools import chain
from typing import TYPE_CHECKING

from launcher.spawn_server.shared_modules import SharedModules

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_FIRST = ("rclpy", "rclpy.node", "rclpy.executors", "rclpy.action", "rclpy.signals")
_INTERFACES = (
    "rcl_interfaces.msg",
    "rcl_interfaces.srv",
    "type_description_interfaces.msg",
    "type_description_interfaces.srv",
    "rosgraph_msgs.msg",
    "builtin_interfaces.msg",
    "action_msgs.msg",
    "std_msgs.msg",
    "sensor_msgs.msg",
    "geometry_msgs.msg",
    "nav_msgs.msg",
    "diagnostic_msgs.msg",
    "ackermann_msgs.msg",
    "tf2_msgs.msg",
    "example_interfaces.srv",
)

IDLE_AFTER_S = 0.3
"""Longer than the pauses during a start, when the CPU is needed by others."""


class Preload:
    """The imports, one step at a time, so that the server can handle requests in between."""

    def __init__(self, packages: Iterable[str] = (), *, cold: bool) -> None:
        """`packages`: import their shared modules too; `cold`: import nothing."""
        self.done = cold
        self.broken = "" if not cold else "cold"
        """Why warm nodes cannot be forked; empty if they can."""
        self.shared = SharedModules()
        self._steps: Iterator[str] = self._all_steps()
        self._idle_steps: Iterator[str] = iter(())
        self._idle = True
        self._packages: set[str] = set()
        self.also(packages)

    @property
    def wait_s(self) -> float | None:
        """How long to wait for a request before the next step; None if there is no next step."""
        if not self.done:
            return 0.0
        return None if self._idle else IDLE_AFTER_S

    def also(self, packages: Iterable[str]) -> None:
        """Add the shared modules of these packages to the imports."""
        new = [package for package in packages if package not in self._packages]
        if new and not self.broken:
            self._packages.update(new)
            self._steps = chain(self._steps, self._shared_steps(new))
            self._idle_steps = chain(self._idle_steps, self._some_steps(new))
            self.done = self._idle = False

    def step(self) -> None:
        """Import the next thing, if there is one."""
        try:
            if not self.done:
                self.done = next(self._steps, None) is None
            elif not self._idle:
                self._idle = next(self._idle_steps, None) is None
        except Exception as problem:  # noqa: BLE001 - the imports are not ours
            self.done = self._idle = True
            self.broken = f"{type(problem).__name__}: {problem}"

    def _all_steps(self) -> Iterator[str]:
        # Imports create hardly any garbage; looking for it would take 50 ms.
        gc.disable()
        for name in _FIRST:
            importlib.import_module(name)
            yield name
        importlib.import_module("rclpy").get_rmw_implementation_identifier()
        for name in _INTERFACES:
            # Not every package is installed everywhere.
            with contextlib.suppress(ImportError):
                _load_types(name)
            yield name
        # The libraries below rclpy have their own threads, which a node does not need.
        warnings.filterwarnings("ignore", message=".*multi-threaded.*fork")
        yield _freeze()

    def _shared_steps(self, packages: Iterable[str]) -> Iterator[str]:
        for package in packages:
            yield from self.shared.load(package)
        yield _freeze()

    def _some_steps(self, packages: Iterable[str]) -> Iterator[str]:
        for package in packages:
            yield from self.shared.load_idly(package)
        yield _freeze()


def _find_callers() -> None:
    """Make `inspect` record where every module is, as it does at its first call.

    rclpy's loggers ask it for the caller's position, which costs 20 ms of a node's start; here it
    is done once for all.
    """
    inspect.getmodule(inspect.currentframe())


def _freeze() -> str:
    """Exclude all current objects from garbage collection, which would write to shared pages."""
    _find_callers()
    gc.freeze()
    gc.enable()
    return "frozen"


def _load_types(module_name: str) -> None:
    """Import a module of interfaces, with the libraries that rcl and Fast DDS load for it.

    These are then loaded and relocated once, in pages that all nodes share.
    """
    module = importlib.import_module(module_name)
    for interface in tuple(vars(module).values()):
        load = getattr(interface, "__import_type_support__", None)
        if load is not None:
            load()
    package = module_name.partition(".")[0]
    for kind in ("fastrtps_c", "introspection_c"):
        with contextlib.suppress(OSError):
            ctypes.CDLL(f"lib{package}__rosidl_typesupport_{kind}.so", mode=os.RTLD_NOW)
