"""A lesson node in the test's own process, on a context and a thread of its own.

It is there in a tenth of the time of a process, and costs a tenth: for what a node computes and
refuses. What becomes of a process that is signalled, stopped or killed is seen with `NodeProcess`.
"""

from __future__ import annotations

import importlib
import threading
from typing import TYPE_CHECKING

import pytest
import rclpy
import rclpy.utilities
from rcl_interfaces.msg import Log
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import LoggingSeverity, get_logger
from rclpy.qos import DurabilityPolicy, QoSProfile

from nodes.parts.node import LessonNode, PeriodicThread
from tests.ros.peer import DISCOVERY
from tests.waiting import wait_until

if TYPE_CHECKING:
    from typing_extensions import Self

LEVELS = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}
ALL_SAID = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class NodeThread:
    """A node of this module, as `NodeProcess` starts it; what it logs is taken from /rosout."""

    def __init__(
        self, module: str, domain: int, *, params: dict[str, object] | None = None, lang: str = "en"
    ) -> None:
        self.module = module
        self._lines: list[str] = []
        self._ending = False
        self._paces: list[PeriodicThread] = []
        argv = ["--ros-args"] if params else []
        for key, value in (params or {}).items():
            argv += ["-p", f"{key}:={str(value).lower() if value in (True, False) else value}"]

        def start(pace: PeriodicThread) -> None:
            self._paces.append(pace)
            pace._thread.start()

        context = Context()
        with pytest.MonkeyPatch.context() as patch:
            for name, value in {**DISCOVERY, "ROS_DOMAIN_ID": str(domain), "DECK_LANG": lang}.items():
                patch.setenv(name, value)
            # A lesson node is the only one of its program, and lives in the default context.
            patch.setattr(rclpy.utilities, "g_default_context", context)
            # Some of its threads end with its process.
            patch.setattr(PeriodicThread, "start", start)
            rclpy.init(args=argv, context=context, domain_id=domain)
            kind = node_of(module)
            # An observer of Deck's in this process silences all without a level of their own.
            get_logger(kind.NAME).set_level(LoggingSeverity.INFO)
            self.node: LessonNode = kind()
        self.node.create_subscription(Log, "/rosout", self._note, ALL_SAID)
        self._context = context
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.node)
        self._thread = threading.Thread(target=self._spin, name=module, daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def output(self) -> str:
        return "\n".join(self._lines)

    def wait_for_words(self, *words: str) -> None:
        """Wait until it has logged these words, in any order."""
        wait_until(
            lambda: all(word in self.output for word in words), lambda: f"{words} from {self.module}:\n{self.output}"
        )

    def close(self) -> None:
        if self._ending:
            return
        self._ending = True
        self._executor.create_task(lambda: None)
        self._thread.join()
        self.node.before_end()
        for pace in self._paces:
            pace.close()
        self._executor.shutdown()
        self.node.destroy_node()  # type: ignore[no-untyped-call]
        self._context.try_shutdown()

    def _spin(self) -> None:
        while not self._ending:
            self._executor.spin_once()

    def _note(self, line: Log) -> None:
        if line.name.split(".")[-1] == self.node.get_name():
            self._lines.append(f"[{LEVELS[line.level]}] [{line.name}]: {line.msg}")


def node_of(module: str) -> type[LessonNode]:
    found = [
        one
        for one in vars(importlib.import_module(module)).values()
        if isinstance(one, type) and issubclass(one, LessonNode) and one.__module__ == module
    ]
    return found[-1]
