"""What agents have called, in the log folder of the run: one JSON object a line, mode 0600."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.consent import AUDIT_FILE
from launcher.private_files import open_file
from text.output import json_text

if TYPE_CHECKING:
    from collections.abc import Mapping

MAX_ARGUMENTS = 4000
"""Most characters of the arguments that are kept."""


class Audit:
    """Appends to the file of one run."""

    def __init__(self, log_dir: str) -> None:
        self.path = Path(log_dir) / AUDIT_FILE

    def write(self, agent: str, tool: str, arguments: Mapping[str, object], outcome: str, took_s: float) -> None:
        """Add a line: time (Unix), client, tool, arguments, outcome, seconds.

        Raises:
            OSError: if it cannot be written.
        """
        kept: object = dict(arguments)
        if len(text := json_text(kept)) > MAX_ARGUMENTS:
            kept = f"{text[:MAX_ARGUMENTS]} …"
        line = {
            "time": round(time.time(), 3),
            "client": agent,
            "tool": tool,
            "arguments": kept,
            "outcome": outcome[:MAX_ARGUMENTS],
            "seconds": round(took_s, 3),
        }
        descriptor = open_file(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        try:
            os.write(descriptor, (json_text(line) + "\n").encode(errors="backslashreplace"))
        finally:
            os.close(descriptor)
