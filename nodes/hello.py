"""Lesson 1: the smallest node there is. It wakes up and counts the seconds."""

from __future__ import annotations

from nodes.parts.node import LessonNode, Number
from nodes.parts.runner import run
from text.i18n import N_

_AWAKE = N_("Hello! The first node is awake.")
_COUNT = N_("{seconds:g} s passed, all is well.")


class HelloNode(LessonNode):
    """Logs how long it has been running."""

    NAME = "hello_node"
    period = Number(1.0, "Time between two messages", low=0.01, high=3600.0, unit="s", fixed=True)

    def __init__(self) -> None:
        super().__init__()
        self._count = 0
        self.every(self.period, self._tick)
        self.say.info(_AWAKE)

    def _tick(self) -> None:
        self._count += 1
        self.say.info(_COUNT, seconds=self._count * self.period)


if __name__ == "__main__":
    raise SystemExit(run(HelloNode))
