"""An examination: the process in which one folder is judged, and the end of all that it starts.

The grader and the examiner (`course.grade.__main__`) speak by lines of JSON over a socket: one request; then from
the examiner `values` once the nodes are started, `step` for each step, `end` at the end. A socket, since the other
end of a pipe can be opened by every process of the same user.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import socket
import sys
import time
from collections.abc import AsyncGenerator, AsyncIterator, Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import psutil

import course
from course.grade.limits import Taken, descendants
from course.proof.trial import Places
from course.results import MOST_BYTES
from launcher.processes.table import read_marks
from launcher.wire import encode
from text.nested import read_json
from text.packing import unpack_text
from text.run_path import OWN_RUN_DIR
from text.sentences import say

EXAMINER = (sys.executable, "-m", "course.grade")
GRACE_S = 15.0
"""How much longer an examiner may take than its nodes."""
ENDED_WITHIN_S = 15.0
"""The guardian's own time for ending what is left, and a little more."""
LOOK_EVERY_S = 0.25
KILLING_ROUNDS, ROUND_S = 100, 0.02
"""How often to look again: a process may just be starting another one."""
KEPT = (
    "HOME", "LANG", "LANGUAGE", "LOGNAME", "PATH", "SHELL", "TERM", "TZ", "USER", "VIRTUAL_ENV",
    "XDG_DATA_HOME", "XDG_DATA_DIRS",
)  # fmt: skip
KEPT_BEGINNINGS = (
    "AMENT_", "CMAKE_PREFIX_", "COLCON_", "CONDA_", "FASTDDS_", "FASTRTPS_", "LC_", "LD_",
    "MALLOC_", "OMP_", "OPENBLAS_", "PIXI_", "PYTHON", "RMW_", "ROS_", "SKIP_DEFAULT_XML_FILE",
)  # fmt: skip
"""What nodes need to find Python and ROS; the token of a CI job is not among it."""
LEFT_OUT = ("PYTHONPYCACHEPREFIX", "ROS_DOMAIN_ID", "ROS_STATIC_PEERS")


@dataclass(frozen=True)
class ExamRequest:
    """What an examiner is to do."""

    lesson: str
    """The folder of the lesson."""
    place: str
    """The folder in which all of it happens, see `course.proof.trial.Places`."""
    cell: Sequence[str]
    """The beginning of the command line of the learner's nodes, see `course.grade.walls`; none: not confined."""
    domain: int
    seed: int
    within_s: float
    """How long all of it may take."""
    language: str
    """The one that nodes log in."""
    bag: str = ""
    """The folder of a recording, which does not exist yet; empty: none is made."""


def own_places(place: Path) -> dict[str, Path]:
    """Return the folders of the judge and of Deck's nodes, by the variables that say so."""
    own = place / "own"
    return {"DECK_STATE_DIR": own / "state", "ROS_LOG_DIR": own / "ros", "TMPDIR": own / "tmp"}


def environment_of(place: Path, environ: Mapping[str, str]) -> dict[str, str]:
    """Return the environment for one grading, without secrets, whose files are all in this place.

    The learner's nodes have some of it replaced, see `course.proof.trial.Places`.
    """
    kept = {
        name: value
        for name, value in environ.items()
        if name not in LEFT_OUT and (name in KEPT or name.startswith(KEPT_BEGINNINGS))
    }
    return {
        **kept,
        OWN_RUN_DIR: str(place / "run"),
        "DECK_LOG_DIR": str(place / "logs"),
        **{variable: str(folder) for variable, folder in own_places(place).items()},
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_THREAD_TIMEOUT": "4",
    }


async def examined(place: Path, request: ExamRequest, room: Sequence[str]) -> AsyncGenerator[dict[str, Any], None]:
    """Yield what an examiner tells, and `end` in any case; by then nothing of it is left.

    `room`: the beginning of the examiner's command line; none: it is not behind walls.
    """
    ours, theirs = socket.socketpair()
    process = await _started(place, theirs, room)
    theirs.close()
    reader, writer = await asyncio.open_connection(sock=ours, limit=MOST_BYTES)
    excess = _Excess()
    watching = asyncio.ensure_future(excess.watch(process, place, request))
    end: dict[str, Any] = {"event": "end", "taken": False}
    reason: str = say("the judge was ended before it was done; killed by what it judged, perhaps")
    try:
        writer.write(encode(asdict(request)))
        async for event in _heard(reader):
            if event["event"] == "end":
                end, reason = event, unpack_text(event["reason"])
                break
            yield event
    finally:
        watching.cancel()
        writer.close()
        await asyncio.shield(asyncio.ensure_future(_end(process, place)))
    yield {**end, "reason": excess.words or reason}


async def _started(place: Path, channel: socket.socket, room: Sequence[str]) -> asyncio.subprocess.Process:
    with (place / "examiner.log").open("wb") as words:
        return await asyncio.create_subprocess_exec(
            *(*room, *EXAMINER, str(channel.fileno())),
            # In that folder `course` is this package, whatever the user's contains.
            cwd=Path(course.__file__).parent.parent,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=words,
            stderr=words,
            env=environment_of(place, os.environ),
            pass_fds=(channel.fileno(),),
            # Ctrl-C in the terminal is meant for its grader.
            start_new_session=True,
        )


async def _heard(reader: asyncio.StreamReader) -> AsyncIterator[dict[str, Any]]:
    with contextlib.suppress(OSError, ValueError):
        while line := await reader.readline():
            yield read_json(line)


class _Excess:
    """What an examiner or what it has started takes too much of."""

    words = ""

    async def watch(self, process: asyncio.subprocess.Process, place: Path, request: ExamRequest) -> None:
        """End it when it does."""
        deadline_s = time.monotonic() + request.within_s + GRACE_S
        places = Places(place, Path(request.lesson).name).writable
        while process.returncode is None:
            await asyncio.sleep(LOOK_EVERY_S)
            words = (await asyncio.to_thread(Taken, process.pid, places)).excess()
            if time.monotonic() > deadline_s:
                words = say("it took longer than {n:g} s", n=request.within_s)
            if words:
                self.words = words
                await asyncio.to_thread(_kill_all, lambda: descendants(process.pid))
                return


async def _end(process: asyncio.subprocess.Process, place: Path) -> None:
    """Return when it and all that it started is gone."""
    with contextlib.suppress(asyncio.TimeoutError):
        await asyncio.wait_for(process.wait(), ENDED_WITHIN_S)
    if process.returncode is None:
        await asyncio.to_thread(_kill_all, lambda: descendants(process.pid))
        process.kill()
        await process.wait()
    # What has ended the guardian, without walls.
    await asyncio.to_thread(_kill_all, lambda: _marked(str(place / "run")))


def _marked(run_dir: str) -> list[psutil.Process]:
    """Return all that has this run directory in its environment."""
    found = []
    for pid in psutil.pids():
        if (read_marks(pid) or {}).get(OWN_RUN_DIR) == run_dir:
            with contextlib.suppress(psutil.NoSuchProcess):
                found.append(psutil.Process(pid))
    return found


def _kill_all(find: Callable[[], Iterable[psutil.Process]]) -> None:
    for _round in range(KILLING_ROUNDS):
        left = list(find())
        if not left:
            return
        # Stopped first, so that none starts another meanwhile.
        for number in (signal.SIGSTOP, signal.SIGKILL):
            for each in left:
                with contextlib.suppress(psutil.Error):
                    each.send_signal(number)
        time.sleep(ROUND_S)
