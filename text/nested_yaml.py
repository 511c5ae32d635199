"""YAML of plain values from elsewhere, bounded in depth as JSON is by `text.nested`."""

from __future__ import annotations

from typing import Any

import yaml

from text.nested import MAX_DEPTH, NestedTooDeeplyError


def read_yaml(text: str) -> Any:  # noqa: ANN401 - anything that YAML can express
    """Parse a YAML text of plain values as `yaml.safe_load` does.

    Raises:
        yaml.YAMLError: if it is none.
        NestedTooDeeplyError: if it is nested deeper than `MAX_DEPTH`.
    """
    depth = 0
    for event in yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        if depth > MAX_DEPTH:
            raise NestedTooDeeplyError
    return yaml.safe_load(text)  # noqa: TID251 - the one place
