"""The record of a run on disk, `<run dir>/<run id>/session.json`, and finding it by the process table.

A supervisor has a mark in its environment, as nodes do: the id of its run, and the descriptor under
which it holds the folder of its run open. Through /proc this leads to the record and the socket,
even if the folder was moved or is in a run directory that is not known here. The kernel allows only
the same user to follow it.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from launcher.control.socket import SOCKET_NAME
from launcher.private_files import make_folder, open_file, open_own_folder, remove_files
from launcher.processes.table import SUPERVISOR_MARK, own_number, process_numbers, read_marks, read_process
from launcher.run_id import is_of_supervisor, supervisor_of, supervisor_runs
from launcher.status import SessionInfo
from launcher.wire import pack, unpack
from text.nested import read_json
from text.run_path import MODEL_USAGE, OWN_RUN_DIR

RECORD_NAME = "session.json"
_DRAFT_NAME = f"{RECORD_NAME}.new"
_LOCKED_WITHIN_S = 20.0
"""A process that holds the lock for longer has been suspended while holding it."""


@dataclass(frozen=True)
class RunRecord:
    """One run, as recorded in its folder."""

    folder: Path
    session: SessionInfo
    nodes: tuple[str, ...]
    drives: bool = False
    """Whether any of the nodes commands the wheels."""

    @property
    def runs(self) -> bool:
        return supervisor_runs(self.session.run_id)

    def collides(self, nodes: set[str], drives: bool) -> bool:
        """Whether it and a run of these nodes would interfere with each other in one domain."""
        unknown = not self.nodes
        return unknown or not nodes.isdisjoint(self.nodes) or (self.drives and drives)

    def write(self) -> None:
        make_folder(self.folder)
        fields = pack(self)
        del fields["folder"]
        draft = self.folder / _DRAFT_NAME
        descriptor = open_file(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        with os.fdopen(descriptor, "w", encoding="utf-8") as file:
            json.dump(fields, file)
        draft.replace(self.folder / RECORD_NAME)

    def remove(self) -> None:
        """Remove the files that the run made in its folder, and the folder if it is then empty."""
        with contextlib.suppress(OSError):
            descriptor = open_own_folder(self.folder)
            try:
                names = [_DRAFT_NAME, RECORD_NAME, SOCKET_NAME, MODEL_USAGE]
                remove_files(self.folder, descriptor, names)
            finally:
                os.close(descriptor)


def read_records(run_dir: Path) -> list[RunRecord]:
    """Return all runs that have a record, oldest first; broken records are skipped."""
    found = (read_record(path.parent) for path in sorted(run_dir.glob(f"*/{RECORD_NAME}")))
    return [record for record in found if record is not None]


def read_record(folder: Path) -> RunRecord | None:
    """Return the record of the run in this folder; None if it is missing or broken."""
    with contextlib.suppress(OSError, ValueError, TypeError):
        written = read_json((folder / RECORD_NAME).read_text(encoding="utf-8"))
        found: RunRecord = unpack(RunRecord, {**written, "folder": folder})
        return found
    return None


@contextlib.contextmanager
def exclusively(run_dir: Path, domain: int) -> Iterator[None]:
    """Keep this user's other supervisors out of a domain while one checks and enters it."""
    descriptor, lock = _lock(run_dir, domain)
    try:
        deadline = time.monotonic() + _LOCKED_WITHIN_S
        while not _taken(lock) and time.monotonic() < deadline:
            time.sleep(0.005)
        yield
    finally:
        os.close(descriptor)


def lock_path() -> Path:
    """Return the file that all supervisors of this user lock, whatever their run directory.

    In a user namespace, where anybody can be root, its name has the uid from outside it.
    """
    user = os.getuid()
    for line in Path("/proc/self/uid_map").read_text(encoding="ascii").splitlines():
        inside, outside, count = map(int, line.split())
        if inside <= user < inside + count:
            user += outside - inside
            break
    return Path(f"/tmp/deck-{user}.lock")


def _lock(run_dir: Path, domain: int) -> tuple[int, Callable[[], None]]:
    """Return a descriptor to be closed, and a function that locks it or raises."""
    with contextlib.suppress(OSError):
        descriptor = open_file(lock_path(), os.O_RDWR | os.O_CREAT)
        if os.fstat(descriptor).st_uid == os.getuid():
            # One byte for each domain: a start in another domain need not wait.
            exclusive = fcntl.LOCK_EX | fcntl.LOCK_NB
            return descriptor, lambda: fcntl.lockf(descriptor, exclusive, 1, domain)
        os.close(descriptor)
    # Another user has created it: then at least lock within one run directory.
    folder = open_own_folder(run_dir)
    return folder, lambda: fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _taken(lock: Callable[[], None]) -> bool:
    try:
        lock()
    except (BlockingIOError, PermissionError):
        return False
    return True


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
