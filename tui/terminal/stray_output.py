"""Output that libraries print past Textual, above all the C++ of DDS: kept in a file.

While the screen runs, descriptors 1 and 2 are redirected to that file; its lines can be read here,
and are shown in the log.
"""

from __future__ import annotations

import contextlib
import os
import sys
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.private_files import open_file

if TYPE_CHECKING:
    from types import TracebackType

    from typing_extensions import Self

MOST_BYTES = 5_000_000
"""The file is emptied when it is larger."""
READ_BYTES = 16_384


class StrayOutput:
    """A context in which all output goes to `path`; an empty file is removed afterwards.

    An existing file of that name is kept, and `path` becomes another name.
    """

    def __init__(self, path: Path) -> None:
        """Set the path; nothing is opened yet."""
        self.path = path
        self._fd = -1
        self._saved: list[tuple[int, int]] = []
        self._read = 0

    def __enter__(self) -> Self:
        """Redirect 1 and 2 to the file."""
        self._fd = self._new_file()
        for number in (1, 2):
            self._saved.append((number, os.dup(number)))
            os.dup2(self._fd, number)
        return self

    def _new_file(self) -> int:
        """Create the file; an existing one of that name belongs to somebody else."""
        flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_APPEND
        named = self.path
        for number in count(2):
            with suppress(FileExistsError):
                return open_file(self.path, flags)
            self.path = named.with_stem(f"{named.stem}-{number}")
        raise AssertionError

    @property
    def terminal_fd(self) -> int:
        """A descriptor for where 1 led before."""
        return self._saved[0][1]

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Restore 1 and 2."""
        for stream in (sys.__stdout__, sys.__stderr__):
            if stream is not None:
                stream.flush()
        for number, saved in self._saved:
            os.dup2(saved, number)
            os.close(saved)
        empty = not os.fstat(self._fd).st_size
        os.close(self._fd)
        if empty:
            self.path.unlink(missing_ok=True)

    def write(self, text: str) -> None:
        """Add output of the screen itself; a full disk is ignored."""
        with contextlib.suppress(OSError):
            os.write(self._fd, text.encode("utf-8", "replace"))

    def new_lines(self) -> list[str]:
        """Return what was printed since the last call; only the newest lines if there are many."""
        size = os.fstat(self._fd).st_size
        if size <= self._read:
            return []
        start = max(self._read, size - READ_BYTES)
        text = os.pread(self._fd, size - start, start).decode("utf-8", "replace")
        self._read = size
        if size > MOST_BYTES:
            os.ftruncate(self._fd, 0)
            self._read = 0
        return [line for line in text.splitlines() if line.strip()]
