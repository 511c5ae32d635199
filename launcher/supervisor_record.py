"""What a run leaves on disk for others to find: who it is, whether it runs, what it has started.

`<run dir>/<run id>/session.json` beside the control socket.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.control_protocol import pack_session, unpack_session
from launcher.supervisor_id import supervisor_runs

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from launcher.status import SessionInfo

RECORD_NAME = "session.json"
_LOCK_NAME = "lock"


@dataclass(frozen=True)
class RunRecord:
    """One run, as its folder tells."""

    folder: Path
    session: SessionInfo
    nodes: tuple[str, ...]
    processes: Mapping[str, tuple[int, int]]
    """Node to the number of its process and its start in ticks."""

    @property
    def runs(self) -> bool:
        """Whether its supervisor is alive."""
        return supervisor_runs(self.session.run_id)

    def write(self) -> None:
        """Write it, all or nothing."""
        self.folder.mkdir(mode=0o700, exist_ok=True)
        fields = {
            "session": pack_session(self.session),
            "nodes": self.nodes,
            "processes": self.processes,
        }
        draft = self.folder / f"{RECORD_NAME}.new"
        draft.write_text(json.dumps(fields), encoding="utf-8")
        draft.replace(self.folder / RECORD_NAME)

    def remove(self) -> None:
        """Take the run's folder away."""
        shutil.rmtree(self.folder, ignore_errors=True)


def read_records(run_dir: Path) -> list[RunRecord]:
    """Return every run that has left a record, oldest first; broken records are passed over."""
    records = []
    for path in sorted(run_dir.glob(f"*/{RECORD_NAME}")):
        with contextlib.suppress(OSError, ValueError, TypeError, KeyError, AttributeError):
            fields = json.loads(path.read_text(encoding="utf-8"))
            processes = {
                str(node): (int(pid), int(started))
                for node, (pid, started) in fields["processes"].items()
            }
            session = unpack_session(fields["session"])
            records.append(RunRecord(path.parent, session, tuple(fields["nodes"]), processes))
    return records


@contextlib.contextmanager
def exclusively(run_dir: Path) -> Iterator[None]:
    """Keep other supervisors from looking and writing at the same time."""
    descriptor = os.open(run_dir / _LOCK_NAME, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def rival(records: list[RunRecord], nodes: tuple[str, ...], domain: int) -> RunRecord | None:
    """Return a run that has one of these nodes in this domain already."""
    for record in records:
        if record.session.domain == domain and set(nodes) & set(record.nodes) and record.runs:
            return record
    return None
