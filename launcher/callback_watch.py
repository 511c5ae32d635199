"""Noticing, inside a learner's node, a callback that runs for long: meanwhile it hears nothing.

One that an executor runs in a thread of its pool is no mistake: the others go on. A thread looks at
the stacks of the others. It needs nothing of rclpy, and no part of Deck: see
`launcher.node_program`.
"""

from __future__ import annotations

import sys
import threading
import time

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from types import CodeType, FrameType

LONG_S = 0.7
LOOK_S = 0.2
"""Both together are less than a second: a callback that sleeps one is noticed."""
_EXECUTOR = "/rclpy/executors.py"
"""What calls the callbacks."""
_POOL = "/concurrent/futures/thread.py"
"""What calls those of a `MultiThreadedExecutor`."""


def watch(folder: str) -> None:
    """Report long callbacks that are defined in this folder, each once, from now on."""
    threading.Thread(target=_look, args=(folder,), daemon=True, name="deck").start()


def _look(folder: str) -> None:
    since: dict[FrameType, float] = {}
    told: set[CodeType] = set()
    while True:
        time.sleep(LOOK_S)
        now = time.monotonic()
        running = {
            callback: line
            for stack in sys._current_frames().values()  # noqa: SLF001 - meant for this
            for callback, line in _callbacks(stack, folder)
        }
        # A frame that is kept is not used for another call: the same one is the same call.
        since = {callback: since.get(callback, now) for callback in running}
        for callback, began in since.items():
            if now - began >= LONG_S and callback.f_code not in told:
                told.add(callback.f_code)
                _report(callback, running[callback])
        del running


def _callbacks(stack: FrameType, folder: str) -> list[tuple[FrameType, int]]:
    """Return what an executor's only thread runs, and the line of the learner's own it is at."""
    found = []
    line = 0
    frame: FrameType | None = stack
    while frame is not None:
        if frame.f_code.co_filename.rpartition("/")[0] == folder:
            line = line or frame.f_lineno
            caller = frame.f_back
            if caller is not None and caller.f_code.co_filename.endswith(_EXECUTOR):
                found.append((frame, line))
        if frame.f_code.co_filename.endswith(_POOL):
            return []
        frame = frame.f_back
    return found


def _report(callback: FrameType, line: int) -> None:
    code = callback.f_code
    words = (
        f"callback {code.co_name} still runs after {LONG_S:g} s: {code.co_filename}, line {line}"
    )
    sys.stderr.write(f"[WARN] [{time.time():.9f}] [deck]: {words}\n")
    sys.stderr.flush()
