"""Which nodes command the wheels: two sessions with such nodes never share a domain."""

from __future__ import annotations

_DRIVERS = frozenset(
    f"nodes.{name}"
    for name in ("ai_brain", "ai_driver", "chassis", "drive_to_point", "electronic_differential", "llm_parser")
)
"""The nodes that command the wheels; two sessions with any of these would fight over them."""


def drives(command: str) -> bool:
    """Whether a node run by this command controls the wheels."""
    return command in _DRIVERS
