"""What nodes tell of themselves when they are asked, as plain data: lifecycle, log, components."""

from __future__ import annotations

from dataclasses import dataclass

LOG_LEVELS = {"debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}
"""Name to number; source: rcl_interfaces/msg/Log."""


@dataclass(frozen=True)
class LifecycleRow:
    """A node with a lifecycle (lifecycle_msgs)."""

    node: str
    """Full name."""
    state: str = ""
    """In the node's words: `unconfigured`, `inactive`, `active`, `finalized`, or that of a
    transition under way, `configuring`; empty as long as it is not known."""
    transitions: tuple[str, ...] = ()
    """Those possible now: `configure`, `shutdown`."""
    error: str = ""
    """Why it did not tell its state when it was last asked; `state` is then the last known."""


@dataclass(frozen=True)
class TransitionResult:
    """The end of a requested transition."""

    node: str
    transition: str
    state: str = ""
    """The state that it led to; empty if that is not known."""
    error: str = ""
    """Why it was not done: not possible now, refused, an error in the node, no answer."""


@dataclass(frozen=True)
class LevelResult:
    """The severity from which on a node logs, or why it does not tell."""

    node: str
    level: str = ""
    """One of `LOG_LEVELS`, or a number between them."""
    error: str = ""


@dataclass(frozen=True)
class ComponentRow:
    """A component in its container."""

    unique_id: int
    node: str
    """Full name."""


@dataclass(frozen=True)
class ContainerRow:
    """A container of components (composition_interfaces)."""

    node: str
    components: tuple[ComponentRow, ...] = ()
    """By their ids."""
    error: str = ""
    """Why it has not told them when it was last asked."""
