"""What is different about ROS in a learner's program that runs under Deck: two changes to modules.

They are made to what is imported already, and to what is imported later. Like `launcher.callback_watch`,
this needs no part of Deck.
"""

from __future__ import annotations

import sys
from importlib.machinery import PathFinder

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any

BYTES = ("std_msgs.msg._byte_multi_array", "example_interfaces.msg._byte_multi_array")
NODE = "rclpy.node"
RULE = "__node:="


class _Changes:
    """Finds these modules, and changes each once it has been run."""

    def __init__(self, names: tuple[str, ...], change: Callable[[ModuleType], None]) -> None:
        self._names, self._change = names, change
        for name in names:
            if name in sys.modules:
                change(sys.modules[name])
        sys.meta_path.insert(0, self)  # type: ignore[arg-type]

    def find_spec(self, name: str, path: Sequence[str] | None, _target: object) -> ModuleSpec | None:
        """Find one of the modules; others are for the next finder."""
        spec = PathFinder.find_spec(name, path) if name in self._names else None
        if spec is None or spec.loader is None:
            return None
        execute = spec.loader.exec_module

        def run(module: ModuleType) -> None:
            execute(module)
            self._change(module)

        spec.loader.exec_module = run  # type: ignore[method-assign]
        return spec


def allow_bytes() -> None:
    """Let a list of bytes take `bytes` where messages check their fields, as it does elsewhere.

    `ROS_PYTHON_CHECK_FIELDS=1` has `ByteMultiArray` refuse `data = b"words"`, which is published well
    without the check. Everything else that is refused would go wrong.
    """
    _Changes(BYTES, _take_bytes)


def _take_bytes(module: ModuleType) -> None:
    checked = module.ByteMultiArray.data

    def put(message: object, value: object) -> None:
        if isinstance(value, (bytes, bytearray)):
            message._data = value  # type: ignore[attr-defined]  # noqa: SLF001
        else:
            checked.fset(message, value)

    module.ByteMultiArray.data = property(checked.fget, put, doc=checked.__doc__)


def keep_names(file: str) -> None:
    """Let the further nodes of a program have their own names, where the first is given another.

    Deck names the node of a profile by `-r __node:=NAME`, which rcl applies to every node of the
    process: two nodes in one file would have one name.
    """
    given = next((word.removeprefix(RULE) for word in sys.argv if word.startswith(RULE)), "")
    if not given:
        return
    from pathlib import Path

    path = Path(file)
    text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
    # A node that is called so already needs no other name, nor does another then take it.
    renamed = given if f'"{given}"' in text or f"'{given}'" in text else ""

    def change(module: ModuleType) -> None:
        """Give each node but one a rule of its own, which comes before that of the process."""
        made = module._rclpy.Node  # noqa: SLF001 - what `Node.__init__` calls

        def make(name: Any, namespace: Any, context: Any, own: Any, *rest: Any) -> Any:  # noqa: ANN401
            nonlocal renamed
            renamed = renamed or str(name)
            if name != renamed:
                own = [*(own or ()), "--ros-args", "-r", f"{RULE}{name}"]
            return made(name, namespace, context, own, *rest)

        module._rclpy.Node = make  # noqa: SLF001

    _Changes((NODE,), change)
