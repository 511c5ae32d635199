"""Finding sessions by the process table: their supervisors, wherever their folders are.

A supervisor has a mark in its environment, as nodes do: the id of its run, and the descriptor under
which it holds the folder of its run open. Through /proc this leads to the record and the socket,
even if the folder was moved or is in a run directory that is not known here. The kernel allows only
the same user to follow it.
"""

from __future__ import annotations

import os
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.processes.table import SUPERVISOR_MARK, own_number, process_numbers, read_marks, read_process
from launcher.run_id import is_of_supervisor, supervisor_of
from launcher.runs.record import read_record
from text.run_path import OWN_RUN_DIR

if TYPE_CHECKING:
    from collections.abc import Iterator

    from launcher.runs.record import RunRecord

MADE_AGAIN_WITHIN_S = 10.0
"""Within this time a supervisor whose folder is gone creates it again."""
_LOOK_AGAIN_S = 0.05


@dataclass(frozen=True)
class FoundSupervisor:
    """A running supervisor of this user's, found by its mark in /proc."""

    run_id: str
    folder: Path
    """The folder of its run, as a path through /proc."""
    domain: int
    purpose: str
    """Its `DECK_RUN_DIR`, with which some users keep runs separate; usually empty."""
    pid: int

    @property
    def place(self) -> str:
        try:
            return str(self.folder.readlink()).removesuffix(" (deleted)")
        except OSError:
            return "?"

    @property
    def holds(self) -> bool:
        """Whether it still holds its folder open; one that is about to end has released it."""
        return os.path.lexists(self.folder)

    def record(self) -> RunRecord | None:
        """Return its record, waiting if it is just being created again; None if there is none."""
        deadline = time.monotonic() + MADE_AGAIN_WITHIN_S
        while True:
            record = read_record(self.folder)
            if record is not None or time.monotonic() > deadline:
                return record
            if not self.holds:
                return None
            time.sleep(_LOOK_AGAIN_S)


def supervisors() -> Iterator[FoundSupervisor]:
    """Yield the supervisors of this user that run a session, but for those in containers."""
    return (one for one in supervisors_everywhere() if one.pid == supervisor_of(one.run_id))


def supervisors_everywhere() -> Iterator[FoundSupervisor]:
    """Yield the same with those that run in containers, where each process has another pid."""
    us = os.getuid()
    for pid in process_numbers():
        with suppress(OSError, ValueError):
            # The superuser could read those of other users.
            if Path(f"/proc/{pid}").stat().st_uid != us:
                continue
            found = _supervisor(pid)
            if found is not None:
                yield found


def _supervisor(pid: int) -> FoundSupervisor | None:
    marks = read_marks(pid) or {}
    run_id, *numbers = marks.get(SUPERVISOR_MARK, "").split("/")
    # Processes that a supervisor starts may have copies of its environment.
    process = read_process(pid) if run_id else None
    if process is None or not is_of_supervisor(run_id, process, own_number(pid)):
        return None
    domain, descriptor = map(int, numbers)
    folder = Path(f"/proc/{pid}/fd/{descriptor}")
    return FoundSupervisor(run_id, folder, domain, marks.get(OWN_RUN_DIR, ""), pid)
