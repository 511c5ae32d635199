"""The environment variables that override a device's settings without editing the profile."""

from __future__ import annotations

import re


def variable(device: str, setting: str) -> str:
    """Return the name of the environment variable that overrides a setting."""
    return re.sub(r"\W", "_", f"DECK_{device}_{setting}".upper(), flags=re.ASCII)
