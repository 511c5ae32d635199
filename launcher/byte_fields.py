"""Letting a list of bytes take `bytes` where messages check their fields, as it does elsewhere.

`ROS_PYTHON_CHECK_FIELDS=1` has `ByteMultiArray` refuse `data = b"words"`, which is published well
without the check. Everything else that is refused would go wrong. Like `launcher.callback_watch`,
this needs no part of Deck.
"""

from __future__ import annotations

import sys
from importlib.machinery import PathFinder

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

MODULES = ("std_msgs.msg._byte_multi_array", "example_interfaces.msg._byte_multi_array")


def allow() -> None:
    """Let the messages that are imported take bytes, and those that are imported later."""
    for name in MODULES:
        if name in sys.modules:
            _let(sys.modules[name])
    sys.meta_path.insert(0, _Later)  # type: ignore[arg-type]


class _Later:
    """Finds the modules with these messages, and changes them once they have been run."""

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None, _target: object) -> ModuleSpec | None:
        """Find one of the modules; others are for the next finder."""
        spec = PathFinder.find_spec(name, path) if name in MODULES else None
        if spec is None or spec.loader is None:
            return None
        execute = spec.loader.exec_module

        def run(module: ModuleType) -> None:
            execute(module)
            _let(module)

        spec.loader.exec_module = run  # type: ignore[method-assign]
        return spec


def _let(module: ModuleType) -> None:
    checked = module.ByteMultiArray.data

    def put(message: object, value: object) -> None:
        if isinstance(value, (bytes, bytearray)):
            message._data = value  # type: ignore[attr-defined]  # noqa: SLF001
        else:
            checked.fset(message, value)

    module.ByteMultiArray.data = property(checked.fget, put, doc=checked.__doc__)
