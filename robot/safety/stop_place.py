"""Where an emergency stop is kept until somebody releases it: a file a domain, in one folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

STATE_DIR = "DECK_STATE_DIR"
"""Environment variable with the folder of what Deck remembers."""


def stop_place(environ: Mapping[str, str], domain: int) -> Path:
    """Return a file of `$DECK_STATE_DIR`, `$XDG_STATE_HOME/deck` or `~/.local/state/deck`.

    Raises:
        RuntimeError: if this user has no home.
    """
    chosen = environ.get(STATE_DIR)
    if chosen:
        return Path(chosen, "stops", str(domain))
    state = environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(state, "deck", "stops", str(domain))
