"""Noticing, inside a learner's node, a callback that runs for long: meanwhile it hears nothing.

One that an executor runs in a thread of its pool is no mistake: the others go on. A thread looks at
the stacks of the others. It needs nothing of rclpy, and no part of Deck: see
`launcher.node_program`.

A callback is stuck if it waits for what only its own thread could bring, or if it does not return
for so long that nobody would wait for it. In a pool it is stuck if it waits for an answer that its
callback group, or the pool, takes in only after it. The main thread is stuck if it does not come to
spin a node that waits for that. Time in which this thread did not run either does not count:
whoever stops the process, or a machine without time for it, makes nobody stuck; nor does a
debugger.
"""

from __future__ import annotations

import gc
import json
import os
import sys
import threading
import time

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Iterable
    from types import CodeType, FrameType
    from typing import Any

LONG_S = 0.7
LOOK_S = 0.2
"""Both together are less than a second: a callback that sleeps one is noticed."""
DEADLOCK_S = 3.0
"""How long it may wait for what cannot come, such as the answer to `Client.call`."""
STUCK_S = 30.0
"""How long any other callback may run before it counts as stuck; it is told if it goes on."""
UNSPUN_S = 15.0
"""How long the main thread may take before it spins a node for the first time."""
_EXECUTOR = "/rclpy/executors.py"
"""What calls the callbacks."""
_CLIENT = "/rclpy/client.py"
_POOL = "/concurrent/futures/thread.py"
"""What calls those of a `MultiThreadedExecutor`."""
_DEBUGGERS = ("/bdb.py", "/pdb.py", "/pydevd.py")
CALL, SPIN, RATE, OTHER = "call", "spin", "rate", ""
"""What a callback waits in."""
GROUP, POOL = "group", "pool"
"""What keeps the answer from one that runs in a pool."""
MAIN, MAIN_CALL, MAIN_RATE, MAIN_SERVICE = "main", "main_call", "main_rate", "main_service"
"""Where the main thread is that has not spun yet."""


class _Callback:
    """A callback that runs; or a function of the main thread that has not spun yet."""

    def __init__(
        self, frame: FrameType, line: int, waits_in: str, bound_s: float, *, alone: bool = True
    ) -> None:
        """`alone`: nothing else is done meanwhile, so that it is told early that it runs."""
        self.frame = frame
        self.line = line
        self.waits_in = waits_in
        self.bound_s = bound_s
        self.alone = alone
        self.name = frame.f_code.co_name
        self.in_constructor = False
        """Whether it is one of the main thread that makes a node."""
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
        stacks = sys._current_frames()  # noqa: SLF001 - meant for this
        stacks.pop(threading.get_ident(), None)
        running = {callback.frame: callback for callback in _all_that_run(stacks, folder)}
        # A frame that is kept is not used for another call: the same one is the same call.
        for frame, callback in running.items():
            earlier = known.get(frame)
            if earlier is not None:
                callback.ran_s, callback.stuck = earlier.ran_s + passed_s, earlier.stuck
            if callback.alone and callback.ran_s >= LONG_S and frame.f_code not in told:
                told.add(frame.f_code)
                _report(callback)
            if tells and not callback.stuck and callback.ran_s >= callback.bound_s:
                callback.stuck = _is_proven(callback)
                # What is not now is looked at once more when so long has passed again.
                callback.ran_s = callback.ran_s if callback.stuck else 0.0
                if callback.stuck:
                    _tell(callback)
        for frame, callback in known.items():
            if callback.stuck and frame not in running:
                _tell(callback, over=True)
        known = running
        del running, stacks


def _all_that_run(stacks: dict[int, FrameType], folder: str) -> list[_Callback]:
    found = [each for stack in stacks.values() for each in _callbacks(stack, folder)]
    found += _deadlocked([each for each in map(_Waiting.in_pool, stacks.values()) if each], folder)
    spins = any(_spins(frame) for stack in stacks.values() for frame in _down(stack))
    main = stacks.get(threading.main_thread().ident or 0)
    if main is not None and not spins:
        found += _unspun(main, folder)
    return found


def _down(stack: FrameType | None) -> Iterable[FrameType]:
    """Yield the frames of a stack, the innermost first."""
    while stack is not None:
        yield stack
        stack = stack.f_back


def _spins(frame: FrameType) -> bool:
    of_rclpy = _is_of(frame, "/rclpy/__init__.py") and frame.f_code.co_name.startswith("spin")
    return of_rclpy or _is_of(frame, _EXECUTOR)


def _is_of(frame: FrameType, *files: str) -> bool:
    return frame.f_code.co_filename.endswith(files)


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
                bound_s = DEADLOCK_S if waits_in else STUCK_S
                found.append(_Callback(frame, line, waits_in, bound_s))
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


class _Waiting:
    """A callback in a thread of a pool that waits, without a limit, for what an executor brings."""

    def __init__(self, stack: FrameType, client: object, entity: object, pool: object) -> None:
        self.stack = stack
        self.client = client
        """The client whose answer it waits for; None if it waits for something else."""
        self.entity = entity
        """What its callback group has lent itself to; None if it is in none."""
        self.pool = pool

    @classmethod
    def in_pool(cls, stack: FrameType) -> _Waiting | None:
        """Return what waits in this thread; None if nothing does, or it is no thread of a pool."""
        waits_in, client, entity = OTHER, None, None
        for frame in _down(stack):
            if _is_of(frame, *_DEBUGGERS):
                return None
            waits_in = _waiting(frame) or waits_in
            if waits_in == CALL and client is None and _is_of(frame, _CLIENT):
                client = frame.f_locals.get("self")
            if frame.f_code.co_name == "handler" and _is_of(frame, _EXECUTOR):
                entity = frame.f_locals.get("entity")
            if frame.f_code.co_name == "_worker" and _is_of(frame, _POOL):
                reference = frame.f_locals.get("executor_reference")
                pool = reference() if callable(reference) else None
                return cls(stack, client, entity, pool) if waits_in else None
        return None

    @property
    def waits_for(self) -> object:
        """What has the callback group that would take in the answer; None if it is free."""
        return getattr(getattr(self.client, "callback_group", None), "_active_entity", None)


def _deadlocked(waiting: list[_Waiting], folder: str) -> list[_Callback]:
    """Return those that wait for each other, or for themselves."""
    found = []
    for each in waiting:
        all_of_pool = [one for one in waiting if one.pool is each.pool]
        why = ""
        if _comes_round(each, waiting):
            why = GROUP
        elif len(all_of_pool) >= getattr(each.pool, "_max_workers", len(waiting) + 1):
            why = POOL
        own = _own_frame(each.stack, folder)
        if why and own is not None:
            found.append(_Callback(own, own.f_lineno, why, DEADLOCK_S, alone=False))
    return found


def _comes_round(first: _Waiting, waiting: list[_Waiting]) -> bool:
    """Whether what keeps an answer back waits itself, and so on, without an end."""
    by_entity = {id(each.entity): each for each in waiting if each.entity is not None}
    met: set[int] = set()
    now: _Waiting | None = first
    while now is not None and now.waits_for is not None:
        if id(now.waits_for) in met:
            return True
        met.add(id(now.waits_for))
        now = by_entity.get(id(now.waits_for))
    return False


def _own_frame(stack: FrameType, folder: str) -> FrameType | None:
    """Return the innermost frame of the learner's own."""
    own = (each for each in _down(stack) if _is_in(each, folder))
    return next(own, None)


def _is_in(frame: FrameType, folder: str) -> bool:
    return frame.f_code.co_filename.rpartition("/")[0] == folder


def _unspun(stack: FrameType, folder: str) -> list[_Callback]:
    """Return where the main thread is if it has a node that waits for being spun."""
    own = _own_frame(stack, folder)
    frames = list(_down(stack))
    if own is None or any(_is_of(frame, *_DEBUGGERS) for frame in frames):
        return []
    inside = frames[: frames.index(own)]
    waits_in = next(filter(None, map(_waiting, inside)), OTHER)
    where = {CALL: MAIN_CALL, RATE: MAIN_RATE}.get(waits_in, MAIN)
    if any(_is_of(each, _CLIENT) and each.f_code.co_name == "wait_for_service" for each in inside):
        where = MAIN_SERVICE
    if where in (MAIN_CALL, MAIN_RATE):
        return [_Callback(own, own.f_lineno, where, DEADLOCK_S, alone=False)]
    # The outermost: it stays, whatever it calls by turns.
    first = next(each for each in reversed(frames) if _is_in(each, folder))
    callback = _Callback(first, own.f_lineno, where, UNSPUN_S, alone=False)
    callback.name = own.f_code.co_name
    node = _class_of("rclpy.node", "Node")
    callback.in_constructor = any(
        each.f_code.co_name == "__init__" and isinstance(each.f_locals.get("self"), node)
        for each in frames
    )
    return [callback]


def _class_of(module: str, name: str) -> Any:  # noqa: ANN401
    """Return a class for `isinstance`; one that nothing is of, where it has not been imported."""
    return getattr(sys.modules.get(module), name, ())


def _is_proven(callback: _Callback) -> bool:
    """Whether what has taken so long can be nothing else: of a main thread that has not spun yet.

    No executor has ever spun, and there is a node with something to be called, or not yet whole.
    """
    if callback.waits_in not in (MAIN, MAIN_SERVICE):
        return True
    node, executor = _class_of("rclpy.node", "Node"), _class_of("rclpy.executors", "Executor")
    everything = gc.get_objects()
    if any(isinstance(each, executor) and _has_spun(each) for each in everything):
        return False
    return callback.in_constructor or any(
        isinstance(each, node) and _awaits_calls(each) for each in everything
    )


def _has_spun(executor: object) -> bool:
    return getattr(executor, "_last_args", None) is not None


def _awaits_calls(node: Any) -> bool:  # noqa: ANN401 - a node of rclpy
    """Whether a node has timers, subscriptions, clients or services of its learner's."""
    own = ("timers", "subscriptions", "clients")
    try:
        prefix = f"{node.get_fully_qualified_name()}/"
        served = (each.srv_name for each in node.services)
        return any(any(True for _ in getattr(node, kind)) for kind in own) or not all(
            name.startswith(prefix) for name in served
        )
    except Exception:  # noqa: BLE001 - its constructor is not through: nothing can be said
        return False


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
        "name": callback.name,
        "file": code.co_filename,
        "line": callback.line,
        "waits_in": callback.waits_in,
        "since_s": time.time() - callback.ran_s,
        "over": over,
    }
    sys.stderr.flush()
    os.write(2, b"\x1b]deck;" + json.dumps({"callback": seen}).encode() + b"\x07\n")
