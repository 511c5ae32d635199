"""Where an emergency stop is stored until somebody releases it: one file per domain."""

from __future__ import annotations

import os
from pathlib import Path

from platformdirs import user_state_path

STATE_DIR = "DECK_STATE_DIR"
"""Environment variable with the folder of Deck's saved state."""


def stop_place(domain: int) -> Path:
    """Return a file in `$DECK_STATE_DIR`, `$XDG_STATE_HOME/deck` or `~/.local/state/deck`.

    Raises:
        RuntimeError: if this user has no home directory.
    """
    chosen = os.environ.get(STATE_DIR)
    state = Path(chosen) if chosen else user_state_path("deck")
    return state / "stops" / str(domain)
