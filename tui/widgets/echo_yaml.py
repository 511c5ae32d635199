"""A message as YAML for the clipboard, as `ros2 topic echo` and `ros2 topic pub` write it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml

if TYPE_CHECKING:
    from graph.data import Value

LONGEST_ARRAY = 2000
LONGEST_TEXT = 64 * 1024
"""What a terminal still takes as a clipboard (OSC 52)."""


def yaml_text(message: Mapping[str, Value]) -> tuple[str, bool]:
    """The message as YAML, and whether arrays or texts had to be cut for it to fit a clipboard."""
    cut = [False]
    tree = _tree(message, cut)
    text = yaml.safe_dump(tree, allow_unicode=True, sort_keys=False, default_flow_style=None)
    return text, cut[0]


def _tree(value: Value, cut: list[bool]) -> Any:  # noqa: ANN401 - what PyYAML takes
    if isinstance(value, Mapping):
        return {str(key): _tree(below, cut) for key, below in value.items()}
    if isinstance(value, str):
        cut[0] = cut[0] or len(value) > LONGEST_TEXT
        return value[:LONGEST_TEXT]
    if isinstance(value, (bool, int, float)):
        return value
    cut[0] = cut[0] or len(value) > LONGEST_ARRAY
    head = value[:LONGEST_ARRAY]
    if isinstance(head, (bytes, np.ndarray)):
        return list(head) if isinstance(head, bytes) else head.tolist()
    return [_tree(item, cut) for item in head]
