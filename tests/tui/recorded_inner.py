"""Inner states that were written down: lifecycles, log levels, components."""

from __future__ import annotations

from typing import Any

from graph.data import GraphUpdate, NodeRow
from graph.inner_states import ComponentRow, ContainerRow, LifecycleRow
from tests.tui.recorded_nodes import NODE_ROWS, graph_update

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
