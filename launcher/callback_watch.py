"""Noticing, inside a learner's node, a callback that runs for long: meanwhile it hears nothing.

One that an executor runs in a thread of its pool is no mistake: the others go on. A thread looks at
the stacks of the others. It needs nothing of rclpy, and no part of Deck: see
`launcher.node_program`.

A callback is stuck if it waits for what only its own thread could bring, or if it does not return
for so long that nobody would wait for it. Time in which this thread did not run either does not
count: whoever stops the process, or a machine without time for it, makes nobody stuck; nor does a
debugger.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from types import CodeType, FrameType

LONG_S = 0.7
LOOK_S = 0.2
"""Both together are less than a second: a callback that sleeps one is noticed."""
DEADLOCK_S = 3.0
"""How long it may wait for what cannot come, such as the answer to `Client.call`."""
STUCK_S = 30.0
"""How long any other callback may run before it counts as stuck; it is told if it goes on."""
_EXECUTOR = "/rclpy/executors.py"
"""What calls the callbacks."""
_POOL = "/concurrent/futures/thread.py"
"""What calls those of a `MultiThreadedExecutor`."""
_DEBUGGERS = ("/bdb.py", "/pdb.py", "/pydevd.py")
CALL, SPIN, RATE, OTHER = "call", "spin", "rate", ""
"""What a callback waits in."""


class _Callback:
    """A callback that runs."""

    def __init__(self, frame: FrameType, line: int, waits_in: str) -> None:
        self.frame = frame
        self.line = line
        self.waits_in = waits_in
        self.ran_s = 0.0
        self.stuck = False


def watch(folder: str, *, tells: bool = True) -> None:
    """Report long callbacks that are defined in this folder, each once, from now on.

    `tells`: tell the supervisor of those that are stuck, and when they go on.
    """
    threading.Thread(target=_look, args=(folder, tells), daemon=True, name="deck").start()


def _look(folder: str, tells: bool) -> None:
    known: dict[FrameType, _Callback] = {}
    told: set[CodeType] = set()
    before = time.monotonic()
    while True:
        time.sleep(LOOK_S)
        now = time.monotonic()
        passed_s = min(now - before, 2 * LOOK_S)
        before = now
        running = {
            callback.frame: callback
            for stack in sys._current_frames().values()  # noqa: SLF001 - meant for this
            for callback in _callbacks(stack, folder)
        }
        # A frame that is kept is not used for another call: the same one is the same call.
        for frame, callback in running.items():
            earlier = known.get(frame)
            if earlier is not None:
                callback.ran_s, callback.stuck = earlier.ran_s + passed_s, earlier.stuck
            if callback.ran_s >= LONG_S and frame.f_code not in told:
                told.add(frame.f_code)
                _report(callback)
            if tells and not callback.stuck and callback.ran_s >= _bound_s(callback):
                callback.stuck = True
                _tell(callback)
        for frame, callback in known.items():
            if callback.stuck and frame not in running:
                _tell(callback, over=True)
        known = running
        del running


def _bound_s(callback: _Callback) -> float:
    return DEADLOCK_S if callback.waits_in else STUCK_S


def _callbacks(stack: FrameType, folder: str) -> list[_Callback]:
    """Return what an executor's only thread runs, and the line of the learner's own it is at."""
    found = []
    line, waits_in = 0, OTHER
    frame: FrameType | None = stack
    while frame is not None:
        file = frame.f_code.co_filename
        if file.endswith((_POOL, *_DEBUGGERS)):
            return []
        if file.rpartition("/")[0] == folder:
            line = line or frame.f_lineno
            caller = frame.f_back
            if caller is not None and caller.f_code.co_filename.endswith(_EXECUTOR):
                found.append(_Callback(frame, line, waits_in))
        elif not line:
            waits_in = _waiting(frame) or waits_in
        frame = frame.f_back
    return found


def _waiting(frame: FrameType) -> str:
    """Return in which function of rclpy a callback waits for its own thread."""
    file, name = frame.f_code.co_filename, frame.f_code.co_name
    if file.endswith("/rclpy/client.py") and name == "call":
        return CALL if frame.f_locals.get("timeout_sec") is None else OTHER
    if file.endswith("/rclpy/__init__.py") and name.startswith("spin"):
        return SPIN if frame.f_locals.get("timeout_sec") is None else OTHER
    return RATE if file.endswith("/rclpy/timer.py") and name == "sleep" else OTHER


def _report(callback: _Callback) -> None:
    code = callback.frame.f_code
    within = f" in {callback.waits_in}" if callback.waits_in else ""
    words = (
        f"callback {code.co_name} still runs after {LONG_S:g} s{within}: {code.co_filename}, "
        f"line {callback.line}"
    )
    sys.stderr.write(f"[WARN] [{time.time():.9f}] [deck]: {words}\n")
    sys.stderr.flush()


def _tell(callback: _Callback, *, over: bool = False) -> None:
    """Tell the supervisor, as `launcher.faults.telling` reads it."""
    code = callback.frame.f_code
    seen = {
        "name": code.co_name,
        "file": code.co_filename,
        "line": callback.line,
        "waits_in": callback.waits_in,
        "since_s": time.time() - callback.ran_s,
        "over": over,
    }
    sys.stderr.flush()
    os.write(2, b"\x1b]deck;" + json.dumps({"callback": seen}).encode() + b"\x07\n")
