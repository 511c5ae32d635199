"""The process of the viewer: `deck view --json`, which ends with this screen."""

from __future__ import annotations

import asyncio
import contextlib
import sys
from asyncio.subprocess import PIPE, Process
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from text.i18n import language
from text.nested import read_json
from text.plain import plain_lines

if TYPE_CHECKING:
    from asyncio import StreamReader, Task
    from collections.abc import Sequence

ROOT = Path(__file__).resolve().parents[2]
END_S = 10.0
LONGEST = 1000


class NotOpenedError(Exception):
    """Why there is no viewer, a sentence in the language of the screen."""


@dataclass(frozen=True)
class OpenedView:
    """Where the viewer is open."""

    url: str
    """Of the page; empty if it has a window of its own."""
    ports: tuple[int, ...] = ()
    ssh: str = ""
    """What forwards them to the user's own machine; empty without SSH."""


class ViewProcess:
    """A viewer that is open, until its user closes it or it is ordered to end."""

    def __init__(self, process: Process, opened: OpenedView, words: Task[str]) -> None:
        """`words` become what it has said last on standard error."""
        self.opened = opened
        self._process = process
        self._words = words

    @property
    def ended(self) -> bool:
        return self._process.returncode is not None

    async def fault(self) -> str:
        """Return why it has ended, empty if its user closed it."""
        return await self._words if self._process.returncode else ""

    async def end(self) -> None:
        await _end(self._process)


async def start_view(domain: int, options: Sequence[str] = ()) -> ViewProcess:
    """Open the viewer of a domain. Raises NotOpenedError."""
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "tui", "view"),
        *("--json", "--no-open", "--domain", str(domain), "--lang", language(), *options),
        cwd=ROOT,
        stdin=PIPE,
        stdout=PIPE,
        stderr=PIPE,
        # Ctrl-C in this terminal is meant for the screen.
        start_new_session=True,
    )
    assert process.stdout is not None
    assert process.stderr is not None
    words = asyncio.create_task(_last_words(process.stderr))
    try:
        line = await process.stdout.readline()
    except BaseException:
        await _end(process)
        raise
    if not line:
        await process.wait()
        raise NotOpenedError(await words)
    told = read_json(line)
    opened = OpenedView(str(told["url"]), tuple(told["ports"]), str(told["ssh"]))
    return ViewProcess(process, opened, words)


async def _last_words(stream: StreamReader) -> str:
    """Read to the end, so that nobody waits for a reader; return the end of it."""
    kept = b""
    while more := await stream.read(4096):
        kept = (kept + more)[-LONGEST:]
    return plain_lines(kept.decode(errors="replace").strip())


async def _end(process: Process) -> None:
    assert process.stdin is not None
    process.stdin.close()
    try:
        await asyncio.wait_for(process.wait(), END_S)
    except asyncio.TimeoutError:
        with contextlib.suppress(ProcessLookupError):
            process.kill()
        await process.wait()
