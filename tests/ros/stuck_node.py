"""A node whose end hangs in C with the interpreter's lock held, as Fast DDS has been seen to."""

from __future__ import annotations

import ctypes
import sys

from nodes.parts.node import LessonNode
from nodes.parts.runner import run
from text.i18n import N_


class Stuck(LessonNode):
    """Cannot be closed."""

    NAME = "stuck"

    def __init__(self) -> None:
        super().__init__()
        self.say.info(N_("up"))

    def destroy_node(self) -> None:
        """Wait for an hour; `PyDLL` keeps the lock."""
        ctypes.PyDLL(None).sleep(3600)


if __name__ == "__main__":
    sys.exit(run(Stuck))
