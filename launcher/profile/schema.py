"""The JSON schema of profiles, for editors: `python -m launcher.profile.schema > schema.json`."""

from __future__ import annotations

import json
import sys
from typing import Any

from launcher.profile.model import ProfileDocument


def render() -> str:
    """Return the correct content of `profiles/schema.json`."""
    schema: dict[str, Any] = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    schema |= ProfileDocument.model_json_schema(by_alias=True)
    return json.dumps(_without_noise(schema), indent=2, ensure_ascii=False) + "\n"


def _without_noise(value: Any) -> Any:  # noqa: ANN401 - any JSON
    """Drop pydantic's additions, which would only clutter the hints of an editor."""
    if isinstance(value, list):
        return [_without_noise(item) for item in value]
    if not isinstance(value, dict):
        return value
    return {
        key: _without_noise(inner)
        for key, inner in value.items()
        if not (key == "title" and isinstance(inner, str) and "description" in value)
        and not (key == "default" and inner in (None, {}, [], ""))
    }


if __name__ == "__main__":
    sys.stdout.write(render())
