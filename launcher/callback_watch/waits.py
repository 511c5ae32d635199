"""What a thread, or a coroutine, waits for: an answer, a service, a lock, a change."""

from __future__ import annotations

import contextlib
import linecache

from .loops import is_property, loop_at, values_in
from .stacks import ACTION_CLIENT, CLIENT, EXECUTORS, RCLPY, class_of, is_in, is_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable
    from types import FrameType
    from typing import Any

    from .loops import Loop
    from .stacks import Thread

CALL, SPIN, RATE, AWAIT = "call", "spin", "rate", "await"
"""How one waits in rclpy."""
SERVER = "server"
EVENT, LOCK, LOOP = "event", "lock", "loop"
"""How one waits without it."""
_LOCKS = ("/threading.py", "/queue.py", "/concurrent/futures/_base.py")
_BLOCKING = ("send_goal", "_get_result", "_cancel_goal")
_PENDING = ("_pending_requests", "_pending_goal_requests", "_pending_result_requests", "_pending_cancel_requests")
"""Where a client keeps the futures of answers that have not come."""


class Wait:
    """A wait that has not ended."""

    def __init__(self, how: str, frame: FrameType, own: FrameType, *, limited: bool = False) -> None:
        """`frame`: what waits, the same as long as it is the same wait; `own`: the learner's."""
        self.how = how
        self.frame = frame
        self.own = own
        self.limited = limited
        """Whether it ends after a time, and may be begun anew."""
        self.future: Any = None
        self.client: Any = None
        """The client of a service or action that it waits for; None if that is not known."""
        self.awaited: object = None
        """What it waits for if that is nothing of rclpy: an `Event`, a `Queue`."""
        self.spins = how == SPIN
        """Whether callbacks are called meanwhile, by this thread."""
        self.entity: Any = None
        """What its callback group has lent itself to; None if it is in none."""
        self.pool: Any = None
        """The pool whose thread it keeps."""
        self.thread = 0

    def for_future(self, future: object) -> Wait:
        self.future, self.client = future, owner(future)
        return self


def waits_of(thread: Thread) -> list[Wait]:
    """Return all waits on the stack of a thread: within one that spins there may be another."""
    spinning = [each for frame in thread.frames if (each := _spinning(frame, thread)) is not None]
    found = [each for each in spinning if each.future is not None] + _innermost(thread)
    met = {each.own for each in found if not each.limited}
    for frame in thread.own:
        loop = loop_at(frame) if frame not in met else None
        waits = _looping(frame, loop) if loop is not None else None
        if waits is not None and waits.future is not None:
            met.add(frame)
        found += [waits] if waits is not None else []
    found += [each for each in spinning if each.future is None and each.own not in met]
    for each in found:
        each.entity, each.pool = thread.entity_around(each.own), thread.pool
        each.thread = thread.number
    return found


def _spinning(frame: FrameType, thread: Thread) -> Wait | None:
    own = frame.f_back
    if own is None or own not in thread.own or not is_of(frame, RCLPY, EXECUTORS):
        return None
    name, limited = frame.f_code.co_name, not _is_endless(frame.f_locals.get("timeout_sec"))
    if name == "spin_until_future_complete":
        return Wait(SPIN, frame, own, limited=limited).for_future(frame.f_locals.get("future"))
    if name.startswith("spin") and is_of(frame, RCLPY):
        return Wait(SPIN, frame, own, limited=limited)
    return None


def _innermost(thread: Thread) -> list[Wait]:
    """Return what the innermost function of the learner's own waits in."""
    if not thread.own:
        return []
    own = thread.own[0]
    inside = thread.frames[: thread.frames.index(own)]
    if not inside and _acquires(own):
        return [Wait(LOCK, own, own)]
    for frame in reversed(inside):
        if is_of(frame, *_LOCKS):
            return _locked(frame, inside, own)
        wait = _asking(frame, own)
        if wait is not None:
            return [wait]
    return []


def _asking(frame: FrameType, own: FrameType) -> Wait | None:
    """Return the wait of one of the functions of rclpy that do not spin."""
    name, local = frame.f_code.co_name, frame.f_locals
    if is_of(frame, CLIENT, ACTION_CLIENT) and name.startswith("wait_for_serv"):
        wait = Wait(SERVER, frame, own, limited=local.get("timeout_sec") != float("inf"))
        wait.client = local.get("self")
        return wait
    if is_of(frame, CLIENT) and name == "call" and "future" in local:
        limited = not _is_endless(local.get("timeout_sec"))
        return Wait(CALL, frame, own, limited=limited).for_future(local["future"])
    if is_of(frame, ACTION_CLIENT) and name in _BLOCKING:
        future = local.get("send_goal_future", local.get("future"))
        if future is not None and not future.done():
            return Wait(CALL, frame, own).for_future(future)
    if is_of(frame, "/rclpy/timer.py") and name == "sleep":
        return Wait(RATE, frame, own)
    return None


def _locked(outer: FrameType, inside: list[FrameType], own: FrameType) -> list[Wait]:
    """Return the wait for something of `threading` or `queue`, if it has no limit."""
    if not is_of(inside[0], "/threading.py"):
        return []
    if any(each.f_locals.get("timeout") is not None for each in inside if is_of(each, *_LOCKS)):
        return []
    wait = Wait(EVENT, outer, own)
    wait.awaited = outer.f_locals.get("self")
    return [wait]


def _acquires(own: FrameType) -> bool:
    """Whether a line takes a lock: of that, which is written in C, there is no frame."""
    line = linecache.getline(own.f_code.co_filename, own.f_lineno)
    return ".acquire()" in line or (line.lstrip().startswith("with ") and "lock" in line.lower())


def _looping(frame: FrameType, loop: Loop) -> Wait | None:
    asked = [one for each in loop.futures for one in values_in(frame, each)]
    kind = class_of("rclpy.task", "Future")
    future = next((each for each in asked if isinstance(each, kind) and not each.done()), None)
    if future is None and not loop.endless:
        return None
    # A property may look at the clock.
    limited = not loop.endless or any(is_property(frame, each) for each in loop.attributes)
    wait = Wait(LOOP, frame, frame, limited=limited)
    wait.spins = loop.spins
    return wait.for_future(future) if future is not None else wait


def awaiting(executor: Any, folder: str) -> Iterable[Wait]:  # noqa: ANN401
    """Yield the coroutines of an executor that await a future."""
    for task, entity, _node in tuple(executor._tasks):  # noqa: SLF001
        coroutine, own, future = getattr(task, "_handler", None), None, None
        while coroutine is not None and future is None:
            frame = getattr(coroutine, "cr_frame", None)
            own = frame if frame is not None and is_in(frame, folder) else own
            coroutine = getattr(coroutine, "cr_await", None)
            waiting = getattr(coroutine, "gi_frame", None)
            future = waiting.f_locals.get("self") if waiting is not None else None
        if own is not None and isinstance(future, class_of("rclpy.task", "Future")):
            wait = Wait(AWAIT, own, own).for_future(future)
            wait.entity = entity
            yield wait


def _is_endless(timeout_s: object) -> bool:
    return timeout_s is None or (isinstance(timeout_s, int | float) and timeout_s < 0)


def owner(future: object) -> object:
    """Return the client of a service or action whose answer a future stands for."""
    clients = (class_of("rclpy.client", "Client"), class_of("rclpy.action.client", "ActionClient"))
    for callback in tuple(getattr(future, "_callbacks", ())):
        of = getattr(callback, "__self__", None)
        if isinstance(of, clients):
            return of
    return None


def pending(client: object) -> list[Any]:
    """Return the futures of a client whose answers have not come."""
    kept = (getattr(client, name, {}) for name in _PENDING)
    return [future for each in kept for future in tuple(each.values())]


def is_told(awaited: object, future: object) -> bool:
    """Whether a callback of a future can reach what somebody waits for, such as an `Event`."""
    for callback in tuple(getattr(future, "_callbacks", ())):
        near = [getattr(callback, "__self__", None)]
        for cell in getattr(callback, "__closure__", None) or ():
            with contextlib.suppress(ValueError):  # It is empty yet.
                near.append(cell.cell_contents)
        within = [one for each in near for one in tuple(getattr(each, "__dict__", {}).values())]
        if any(one is awaited for one in (*near, *within)):
            return True
    return False


def is_offered(client: Any) -> bool | None:  # noqa: ANN401
    """Whether somebody offers the service or action; None if that cannot be asked."""
    ask = getattr(client, "service_is_ready", None) or getattr(client, "server_is_ready", None)
    try:
        return bool(ask()) if ask is not None else None
    except Exception:  # noqa: BLE001 - it has been destroyed, or rclpy is shut down
        return None


def name_of(client: Any) -> tuple[str, str]:  # noqa: ANN401
    """Return whether a client is of a service or an action, and the name of that."""
    action = getattr(client, "_action_name", None)
    try:
        if action is None:
            return "service", str(client.service_name)
        return "action", str(client._node.resolve_service_name(action))  # noqa: SLF001
    except Exception:  # noqa: BLE001 - it has been destroyed
        return ("service", str(client.srv_name)) if action is None else ("action", str(action))
