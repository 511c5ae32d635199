"""The run directory, with control sockets and simulated devices, for the launcher and the nodes."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

OWN_RUN_DIR = "DECK_RUN_DIR"
"""Environment variable that keeps some runs separate from all others."""
RUN_ID = "DECK_RUN_ID"
"""Environment variable that tells a node which run it belongs to."""
MODEL_USAGE = "llm_usage.jsonl"
"""File in the folder of a run: what all its processes asked of language models."""


def run_path(environ: Mapping[str, str]) -> Path:
    """Return the run directory that these variables give, whether or not it exists.

    `DECK_RUN_DIR`, else `$XDG_RUNTIME_DIR/deck`, else `/tmp/deck-<uid>`.
    """
    chosen = environ.get(OWN_RUN_DIR)
    if chosen:
        return Path(chosen)
    # Not from platformdirs: without a login session its fallback is not /tmp/deck-<uid>.
    runtime = Path(environ.get("XDG_RUNTIME_DIR") or "/nonexistent")
    if runtime.is_dir() and runtime.stat().st_uid == os.getuid():
        return runtime / "deck"
    return Path(f"/tmp/deck-{os.getuid()}")


def run_folder(environ: Mapping[str, str]) -> Path | None:
    """Return the folder of the run that a node belongs to, None for one that was started alone."""
    run = environ.get(RUN_ID)
    folder = run_path(environ) / run if run else None
    return folder if folder is not None and folder.is_dir() else None
