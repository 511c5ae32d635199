"""What a run leaves on disk for others to find: who it is, whether it runs, what it has started.

`<run dir>/<run id>/session.json` beside the control socket.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.control.protocol import pack_session, unpack_session
from launcher.control.socket import SOCKET_NAME
from launcher.private_files import make_folder, open_file, open_own_folder, remove_files
from launcher.run_id import supervisor_runs

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from launcher.status import SessionInfo

RECORD_NAME = "session.json"
_DRAFT_NAME = f"{RECORD_NAME}.new"
_LOCKED_WITHIN_S = 20.0
"""Whoever holds the lock for longer has been stopped in the middle of it."""


@dataclass(frozen=True)
class RunRecord:
    """One run, as its folder tells."""

    folder: Path
    session: SessionInfo
    nodes: tuple[str, ...]
    processes: Mapping[str, tuple[int, int]]
    """Node to the number of its process and its start in ticks."""
    drives: bool = False
    """Whether any of them gives orders to the wheels."""

    @property
    def runs(self) -> bool:
        """Whether its supervisor is alive."""
        return supervisor_runs(self.session.run_id)

    def collides(self, nodes: set[str], drives: bool) -> bool:
        """Whether it and a run of these nodes would get in each other's way in one domain."""
        unknown = not self.nodes
        return unknown or not nodes.isdisjoint(self.nodes) or (self.drives and drives)

    def write(self) -> None:
        """Write it, all or nothing."""
        make_folder(self.folder)
        fields = {
            "session": pack_session(self.session),
            "nodes": self.nodes,
            "processes": self.processes,
            "drives": self.drives,
        }
        draft = self.folder / _DRAFT_NAME
        descriptor = open_file(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        with os.fdopen(descriptor, "w", encoding="utf-8") as file:
            json.dump(fields, file)
        draft.replace(self.folder / RECORD_NAME)

    def remove(self) -> None:
        """Take away what the run has put into its folder, and the folder if that was all."""
        with contextlib.suppress(OSError):
            descriptor = open_own_folder(self.folder)
            try:
                remove_files(self.folder, descriptor, [_DRAFT_NAME, RECORD_NAME, SOCKET_NAME])
            finally:
                os.close(descriptor)


def read_records(run_dir: Path) -> list[RunRecord]:
    """Return every run that has left a record, oldest first; broken records are passed over."""
    found = (read_record(path.parent) for path in sorted(run_dir.glob(f"*/{RECORD_NAME}")))
    return [record for record in found if record is not None]


def read_record(folder: Path) -> RunRecord | None:
    """Return the record of the run in this folder; None if there is none, or a broken one."""
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError, AttributeError):
        fields = json.loads((folder / RECORD_NAME).read_text(encoding="utf-8"))
        processes = {
            str(node): (int(pid), int(started))
            for node, (pid, started) in fields["processes"].items()
        }
        session = unpack_session(fields["session"])
        drives = bool(fields.get("drives"))
        return RunRecord(folder, session, tuple(fields["nodes"]), processes, drives)
    return None


@contextlib.contextmanager
def exclusively(run_dir: Path, domain: int) -> Iterator[None]:
    """Keep this user's other supervisors out of the domain, while one looks and settles there."""
    descriptor, lock = _lock(run_dir, domain)
    try:
        deadline = time.monotonic() + _LOCKED_WITHIN_S
        while not _taken(lock) and time.monotonic() < deadline:
            time.sleep(0.005)
        yield
    finally:
        os.close(descriptor)


def lock_path() -> Path:
    """Return the file that all of this user's supervisors lock, whatever their run directory.

    In a user namespace, where anybody can be root, it is named by the user outside of it.
    """
    user = os.getuid()
    for line in Path("/proc/self/uid_map").read_text(encoding="ascii").splitlines():
        inside, outside, count = map(int, line.split())
        if inside <= user < inside + count:
            user += outside - inside
            break
    return Path(f"/tmp/deck-{user}.lock")


def _lock(run_dir: Path, domain: int) -> tuple[int, Callable[[], None]]:
    """Return a descriptor to be closed, and what locks it or raises."""
    with contextlib.suppress(OSError):
        descriptor = open_file(lock_path(), os.O_RDWR | os.O_CREAT)
        if os.fstat(descriptor).st_uid == os.getuid():
            # One byte for each domain: a start in another need not wait.
            exclusive = fcntl.LOCK_EX | fcntl.LOCK_NB
            return descriptor, lambda: fcntl.lockf(descriptor, exclusive, 1, domain)
        os.close(descriptor)
    # Somebody else has planted it there: those of one run directory at least.
    folder = open_own_folder(run_dir)
    return folder, lambda: fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _taken(lock: Callable[[], None]) -> bool:
    try:
        lock()
    except (BlockingIOError, PermissionError):
        return False
    return True
