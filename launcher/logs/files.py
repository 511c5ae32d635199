"""The log files of one run, and the folder they are in.

There is a file per node, rotated, written by a thread so that no disk delays a node. The folder has a
mark that lists the files that Deck writes there; it is later removed on the strength of that mark.
Nothing else ever is: neither a folder without a mark, nor files that somebody has put beside the logs.
"""

from __future__ import annotations

import contextlib
import json
import os
import queue
import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from launcher.consent import AUDIT_FILE
from launcher.private_files import make_folder, open_file, open_own_folder, remove_files
from launcher.run_id import supervisor_runs
from text.nested import read_json
from text.os_words import os_reason

MAX_FILE_BYTES = 8 << 20
MAX_OLD_FILES = 3
"""`sonar.log.1` is the newest of them."""
MAX_QUEUED_BYTES = 32 << 20
"""Most bytes queued for a slow disk; beyond that bytes are dropped, and a line counts them."""


class LogFiles:
    """The log files of one run."""

    def __init__(self, folder: Path, on_error: Callable[[str], None]) -> None:
        """`on_error` is called once, on the writing thread, when a file cannot be written."""
        self._folder = folder
        self._on_error = on_error
        self._queue: queue.SimpleQueue[tuple[str, bytes] | None] = queue.SimpleQueue()
        self._queued = 0
        self._lost: dict[str, int] = {}
        self._lock = threading.Lock()
        self._files: dict[str, _RotatedFile] = {}
        self._thread: threading.Thread | None = None

    def write(self, node: str, data: bytes) -> None:
        """Queue data to be appended to a node's file; never blocks."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="log-files", daemon=True)
            self._thread.start()
        with self._lock:
            if self._queued + len(data) > MAX_QUEUED_BYTES:
                self._lost[node] = self._lost.get(node, 0) + len(data)
                return
            lost = self._lost.pop(node, 0)
            if lost:
                data = b"[deck: %d bytes left out, the disk is slow]\n" % lost + data
            self._queued += len(data)
        self._queue.put((node, data))

    def close(self, within_s: float = 3.0) -> None:
        """Write what is queued, as far as time allows."""
        if self._thread is not None:
            self._queue.put(None)
            self._thread.join(within_s)
            self._thread = None

    def _run(self) -> None:
        told = False
        while True:
            item = self._queue.get()
            if item is None:
                break
            node, data = item
            with self._lock:
                self._queued -= len(data)
            try:
                self._file_of(node).write(data)
            except OSError as problem:
                if not told:
                    told = True
                    self._on_error(os_reason(problem))
        for file in self._files.values():
            file.close()

    def _file_of(self, node: str) -> _RotatedFile:
        file = self._files.get(node)
        if file is None:
            file = self._files[node] = _RotatedFile(self._folder / f"{node}.log")
        return file


@dataclass
class _RotatedFile:
    path: Path
    _file: BinaryIO | None = None
    _size: int = 0

    def write(self, data: bytes) -> None:
        if self._file is None:
            make_folder(self.path.parent)
            descriptor = open_file(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            self._file = os.fdopen(descriptor, "ab", buffering=0)
            self._size = os.fstat(descriptor).st_size
        if self._size and self._size + len(data) > MAX_FILE_BYTES:
            self._rotate()
            self.write(data)
            return
        self._file.write(data)
        self._size += len(data)

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def _rotate(self) -> None:
        self.close()
        for number in range(MAX_OLD_FILES - 1, 0, -1):
            older = self.path.with_name(f"{self.path.name}.{number}")
            if older.exists():
                older.replace(self.path.with_name(f"{self.path.name}.{number + 1}"))
        self.path.replace(self.path.with_name(f"{self.path.name}.1"))
        self._size = 0


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
        runs = sorted(entry.name for entry in os.scandir(folder) if entry.is_dir(follow_symlinks=False))
        over = [folder / run for run in runs if not supervisor_runs(run) and _logs_of(folder / run) is not None]
        for run in over[: max(len(over) - keep, 0)]:
            olds = ["", *(f".{number}" for number in range(1, MAX_OLD_FILES + 1))]
            names = [f"{log}.log{old}" for log in _logs_of(run) or () for old in olds]
            with contextlib.suppress(OSError), _opened(run) as descriptor:
                remove_files(run, descriptor, [*names, AUDIT_FILE, MARK])


def _logs_of(run: Path) -> list[str] | None:
    """Return the names of the logs that a run wrote to its folder; None if there is no mark."""
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError), _opened(run) as folder:
        descriptor = open_file(MARK, os.O_RDONLY | os.O_NONBLOCK, folder)
        with os.fdopen(descriptor, encoding="utf-8") as file:
            mark = read_json(file.read(_LONGEST_MARK))
        if mark["run"] == run.name:
            return [log for log in map(str, mark["logs"]) if "/" not in log]
    return None


@contextlib.contextmanager
def _opened(run: Path) -> Iterator[int]:
    descriptor = open_own_folder(run)
    try:
        yield descriptor
    finally:
        os.close(descriptor)
