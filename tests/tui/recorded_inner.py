"""Inner states that were written down: lifecycles, log levels, components."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any, TypeVar

from graph.data import GraphUpdate, NodeRow
from graph.inner_states import ComponentRow, ContainerRow, LevelResult, LifecycleRow, TransitionResult
from tests.tui.recorded_nodes import NODE_ROWS, graph_update

T = TypeVar("T")

LIFECYCLES = (
    LifecycleRow("/camera", "inactive", ("cleanup", "activate", "shutdown")),
    LifecycleRow("/sonar_front", "active", ("deactivate", "shutdown")),
)
CONTAINERS = (ContainerRow("/perception", (ComponentRow(1, "/camera"), ComponentRow(2, "/debayer"))),)


def managed_update(**more: Any) -> GraphUpdate:
    """Lesson 9, where camera and sonar have a lifecycle, and a container holds the camera."""
    facts: dict[str, Any] = {
        "nodes": (*NODE_ROWS, NodeRow("/perception")),
        "lifecycles": LIFECYCLES,
        "containers": CONTAINERS,
    }
    return graph_update(**{**facts, **more})


@dataclass
class RecordedInner:
    """Nodes that do what they are told, and note it."""

    changes: list[tuple[str, str]] = field(default_factory=list)
    """(node, transition)."""
    outcomes: Mapping[str, TransitionResult] = field(default_factory=dict)
    """Transition to what becomes of it, in place of `active`."""
    levels: dict[str, str] = field(default_factory=dict)
    """Node to its level, in place of info."""
    refusals: dict[str, str] = field(default_factory=dict)
    """Node to the reason why its level cannot be read."""

    def change_state(self, node: str, transition: str, timeout_s: float = 5.0) -> Future[TransitionResult]:
        del timeout_s
        self.changes.append((node, transition))
        done = TransitionResult(node, transition, "active")
        return _done(self.outcomes.get(transition, done))

    def logger_level(self, node: str, timeout_s: float = 5.0) -> Future[LevelResult]:
        del timeout_s
        refused = self.refusals.get(node, "")
        level = "" if refused else self.levels.get(node, "info")
        return _done(LevelResult(node, level, refused))

    def set_logger_level(self, node: str, level: str, timeout_s: float = 5.0) -> Future[LevelResult]:
        self.levels[node] = level
        return self.logger_level(node, timeout_s)


def _done(result: T) -> Future[T]:
    future: Future[T] = Future()
    future.set_result(result)
    return future
