"""The log folder of one run: created with a mark, and later removed on the strength of that mark.

The mark lists the files that Deck writes there. Nothing else is ever removed: neither a folder
without a mark, nor files that somebody has put beside the logs.
"""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.consent import AUDIT_FILE
from launcher.logs.files import MAX_OLD_FILES
from launcher.private_files import make_folder, open_file, open_own_folder, remove_files
from launcher.run_id import supervisor_runs
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Iterable

MARK = ".deck-run"
KEPT_RUNS = 10
"""Number of runs of one profile whose logs are kept."""
_LONGEST_MARK = 1 << 20


def make_log_folder(folder: Path, logs: Iterable[str]) -> None:
    """Make the folder of a run, named after its id, for logs of these names.

    Raises:
        OSError: if it cannot be made, or already exists.
    """
    make_folder(folder.parent)
    folder.mkdir(mode=0o700)
    text = json.dumps({"run": folder.name, "logs": sorted(logs)})
    descriptor = open_file(folder / MARK, os.O_WRONLY | os.O_CREAT | os.O_EXCL)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(text)


def prune_runs(folder: Path, keep: int = KEPT_RUNS) -> None:
    """Remove Deck's logs of all but the newest runs of a profile; current runs are kept.

    Args:
        folder: holds one folder per run; their names sort by time.
        keep: how many to keep besides the current runs.
    """
    with contextlib.suppress(OSError):
        runs = [entry.name for entry in os.scandir(folder) if entry.is_dir(follow_symlinks=False)]
        over = sorted(run for run in runs if _is_marked(folder / run) and not supervisor_runs(run))
        for run in over[: max(len(over) - keep, 0)]:
            _remove(folder / run)


def _is_marked(run: Path) -> bool:
    with contextlib.suppress(OSError):
        descriptor = open_own_folder(run)
        try:
            return _marked_logs(run.name, descriptor) is not None
        finally:
            os.close(descriptor)
    return False


def _remove(run: Path) -> None:
    with contextlib.suppress(OSError):
        descriptor = open_own_folder(run)
        try:
            logs = _marked_logs(run.name, descriptor)
            if logs is not None:
                olds = ["", *(f".{number}" for number in range(1, MAX_OLD_FILES + 1))]
                names = [f"{log}.log{old}" for log in logs for old in olds]
                remove_files(run, descriptor, [*names, AUDIT_FILE, MARK])
        finally:
            os.close(descriptor)


def _marked_logs(run_id: str, folder: int) -> list[str] | None:
    """Return the names of the logs that this run wrote here; None if there is no mark."""
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError):
        descriptor = open_file(MARK, os.O_RDONLY | os.O_NONBLOCK, folder)
        with os.fdopen(descriptor, encoding="utf-8") as file:
            mark = read_json(file.read(_LONGEST_MARK))
        if mark["run"] == run_id:
            return [log for log in map(str, mark["logs"]) if "/" not in log]
    return None
