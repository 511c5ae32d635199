"""Letting the further nodes of a program have their own names, where the first is given another.

Deck names the node of a profile by `-r __node:=NAME`, which rcl applies to every node of the
process: two nodes in one file would have one name. Like `launcher.callback_watch`, this needs no
part of Deck.
"""

from __future__ import annotations

import sys
from importlib.machinery import PathFinder
from pathlib import Path

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any

MODULE = "rclpy.node"
RULE = "__node:="


def keep(file: str) -> None:
    """Let the nodes that this program makes keep their names, but for one that is named anew."""
    given = next((word.removeprefix(RULE) for word in sys.argv if word.startswith(RULE)), "")
    if not given:
        return
    naming = _Naming(given, file)
    if MODULE in sys.modules:
        naming.change(sys.modules[MODULE])
    else:
        sys.meta_path.insert(0, naming)  # type: ignore[arg-type]


class _Naming:
    """Finds `rclpy.node`, and changes it once it has been run."""

    def __init__(self, given: str, file: str) -> None:
        self._given = given
        path = Path(file)
        text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
        # A node that is called so already needs no other name, nor does another then take it.
        self._renamed = given if f'"{given}"' in text or f"'{given}'" in text else ""

    def find_spec(self, name: str, path: Sequence[str] | None, _target: object) -> ModuleSpec | None:
        """Find the module; others are for the next finder."""
        spec = PathFinder.find_spec(name, path) if name == MODULE else None
        if spec is None or spec.loader is None:
            return None
        execute = spec.loader.exec_module

        def run(module: ModuleType) -> None:
            execute(module)
            self.change(module)

        spec.loader.exec_module = run  # type: ignore[method-assign]
        return spec

    def change(self, module: ModuleType) -> None:
        """Give each node but one a rule of its own, which comes before that of the process."""
        made = module._rclpy.Node  # noqa: SLF001 - what `Node.__init__` calls

        def make(name: Any, namespace: Any, context: Any, own: Any, *rest: Any) -> Any:  # noqa: ANN401
            self._renamed = self._renamed or str(name)
            if name != self._renamed:
                own = [*(own or ()), "--ros-args", "-r", f"{RULE}{name}"]
            return made(name, namespace, context, own, *rest)

        module._rclpy.Node = make  # noqa: SLF001
