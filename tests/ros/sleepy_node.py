"""A node whose callback does not come back: for the test of how a node ends all the same."""

from __future__ import annotations

import sys
import time

from nodes.parts.node import LessonNode
from nodes.parts.runner import run
from text.i18n import N_


class Sleepy(LessonNode):
    """Falls asleep in its first callback."""

    NAME = "sleepy"

    def __init__(self) -> None:
        super().__init__()
        self.every(0.01, self._sleep)

    def _sleep(self) -> None:
        self.say.info(N_("asleep"))
        time.sleep(3600)


if __name__ == "__main__":
    sys.exit(run(Sleepy))
