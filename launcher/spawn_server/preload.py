"""The imports that the spawn server makes before it forks nodes, so that they need not.

It creates no context, node or thread: a fork copies only the thread that forks.

The package of Deck's nodes lists its modules that nodes share: in `__preload__` those that nearly every node needs,
in `__preload_idle__` those that some need, imported when there is time. Whoever works on Deck may edit them at any
time, so a node that is forked later imports anew what has changed.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import importlib
import inspect
import os
import sys
import warnings
from collections.abc import Iterator
from itertools import chain

from launcher.node_program import INSTALLATION, is_ours

NODES = "nodes"
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

_STANDARD = f"{os.path.dirname(os.__file__)}/"  # noqa: PTH120
"""Where Python's own modules are."""
IDLE_AFTER_S = 0.3
"""Longer than the pauses during a start, when the CPU is needed by others."""


class Preload:
    """The imports, one step at a time, so that the server can handle requests in between."""

    def __init__(self, *, cold: bool) -> None:
        """`cold`: import nothing."""
        self.done = self._idle = cold
        self.broken = "cold" if cold else ""
        """Why warm nodes cannot be forked; empty if they can."""
        self._steps: Iterator[object] = chain(self._ros(), self._shared("__preload__"))
        self._idle_steps: Iterator[object] = self._shared("__preload_idle__")
        self._stamps: dict[str, tuple[float, int] | None] = {}
        """What each of Deck's modules was when it was imported here."""

    @property
    def wait_s(self) -> float | None:
        """How long to wait for a request before the next step; None if there is no next step."""
        if not self.done:
            return 0.0
        return None if self._idle else IDLE_AFTER_S

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

    def renew(self, module: str) -> None:
        """In a forked node, which is to run this module: drop what it has to import itself."""
        if not is_ours(module):
            # By the same names it may mean others.
            for name in [name for name in sys.modules if _stamp(name)]:
                del sys.modules[name]
        elif any(_stamp(name) != stamp for name, stamp in self._stamps.items()):
            for name in self._stamps:
                sys.modules.pop(name, None)
        elif module.startswith(f"{NODES}.") and NODES in sys.modules:
            # It looks at the command line.
            importlib.reload(sys.modules[NODES])

    def _ros(self) -> Iterator[object]:
        # Imports create hardly any garbage; looking for it would take 50 ms.
        gc.disable()
        for name in _FIRST:
            yield importlib.import_module(name)
        importlib.import_module("rclpy").get_rmw_implementation_identifier()
        for name in _INTERFACES:
            # Not every package is installed everywhere.
            with contextlib.suppress(ImportError):
                _load_types(name)
            yield name
        # The libraries below rclpy have their own threads, which a node does not need.
        warnings.filterwarnings("ignore", message=".*multi-threaded.*fork")
        yield _freeze()

    def _shared(self, attribute: str) -> Iterator[object]:
        with contextlib.suppress(Exception):
            yield self._import(NODES)
            for name in getattr(sys.modules[NODES], attribute):
                yield self._import(name)
        yield _freeze()

    def _import(self, name: str) -> object:
        before = set(sys.modules)
        try:
            return importlib.import_module(name, NODES)
        finally:
            new = {name: _stamp(name) for name in set(sys.modules) - before}
            self._stamps |= {name: stamp for name, stamp in new.items() if stamp}


def _stamp(name: str) -> tuple[float, int] | None:
    """Return what differs once a module of Deck has been written; None for others, and if it is gone."""
    file = str(getattr(sys.modules.get(name), "__file__", ""))
    # An environment may lie within Deck's checkout.
    others = name == "__main__" or file.startswith(_STANDARD) or "/site-packages/" in file.removeprefix(INSTALLATION)
    if file.startswith(f"{INSTALLATION}/") and not others:
        with contextlib.suppress(OSError):
            status = os.stat(file)  # noqa: PTH116
            return status.st_mtime, status.st_size
    return None


def _freeze() -> str:
    """Exclude all current objects from garbage collection, which would write to shared pages."""
    # `inspect` records at its first call where every module is. rclpy's loggers ask it for the caller's
    # position, which would cost 20 ms of each node's start.
    inspect.getmodule(inspect.currentframe())
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
