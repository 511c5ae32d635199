"""What a thread, or a coroutine, waits for: an answer, a service, a lock, a change."""

from __future__ import annotations

import ast
import contextlib
import linecache

from .stacks import ACTION_CLIENT, CLIENT, EXECUTORS, RCLPY, class_of, is_in, is_of

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from types import FrameType
    from typing import Any

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


# A loop of the learner's own that waits: for a future, or for what it does not change itself.

_IDLE_CALLS = frozenset({"sleep", "debug", "info", "warning", "warn", "error", "print", "get_logger", "spin_once"})
"""What may be called in a loop that does nothing but wait."""


class Loop:
    """A `while` of the program's text."""

    def __init__(self, loop: ast.While) -> None:
        self.first, self.last = loop.lineno, loop.end_lineno or loop.lineno
        idle = all(map(_is_idle, loop.body))
        asked = [*_asked_done(loop.test)]
        if not asked and idle:
            for each in loop.body:
                asked += _asked_done(each.test) if isinstance(each, ast.If) else []
        self.futures = asked
        """The expressions whose `.done()` ends it."""
        self.endless = idle and _is_plain(loop.test)
        """Whether nothing in it changes what it waits for."""
        self.attributes = [each for each in ast.walk(loop.test) if isinstance(each, ast.Attribute)]
        self.spins = any(_called(each).startswith("spin") for each in ast.walk(loop) if isinstance(each, ast.Call))


def loop_at(frame: FrameType) -> Loop | None:
    """Return the innermost loop that a frame is in, if it waits for something."""
    loops = [each for each in _loops(frame.f_code.co_filename) if _holds(each, frame.f_lineno)]
    loop = max(loops, key=lambda each: each.first, default=None)
    return loop if loop is not None and (loop.futures or loop.endless) else None


def values_in(frame: FrameType, expression: ast.expr) -> list[object]:
    """Return what a name, or an attribute of one, stands for; if it is a list, what is in that."""
    value = _value(frame, expression)
    return list(value) if isinstance(value, list | tuple) else [value]


def is_property(frame: FrameType, attribute: ast.Attribute) -> bool:
    """Whether an attribute is worked out each time, by another than rclpy."""
    found = getattr(type(_value(frame, attribute.value)), attribute.attr, None)
    return isinstance(found, property) and "/rclpy/" not in str(getattr(found.fget, "__code__", None))


def _value(frame: FrameType, expression: ast.expr) -> object:
    """Return the value of a name, or of an attribute of one; None if that is not known."""
    if isinstance(expression, ast.Name):
        name = expression.id
        return frame.f_locals.get(name, frame.f_globals.get(name))
    if isinstance(expression, ast.Attribute):
        return getattr(_value(frame, expression.value), "__dict__", {}).get(expression.attr)
    return None


_known: dict[str, list[Loop]] = {}


def _loops(file: str) -> list[Loop]:
    if file not in _known:
        text = "".join(linecache.getlines(file))
        try:
            tree = ast.parse(text) if "while" in text else ast.Module([], [])
        except (SyntaxError, ValueError, RecursionError):
            tree = ast.Module([], [])
        _known[file] = [Loop(each) for each in ast.walk(tree) if isinstance(each, ast.While)]
    return _known[file]


def _holds(loop: Loop, line: int) -> bool:
    return loop.first <= line <= loop.last


def _asked_done(test: ast.expr) -> Sequence[ast.expr]:
    """Return what `.done()` is called of, or the list that this is taken from."""
    lists = {
        each.target.id: each.iter
        for each in ast.walk(test)
        if isinstance(each, ast.comprehension) and isinstance(each.target, ast.Name)
    }
    asked = [
        call.func.value
        for call in ast.walk(test)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr == "done"
    ]
    return [lists.get(each.id, each) if isinstance(each, ast.Name) else each for each in asked]


def _is_idle(statement: ast.stmt) -> bool:
    if isinstance(statement, ast.If):
        ends = isinstance(statement.body[-1], ast.Break | ast.Return | ast.Raise)
        within = statement.orelse if ends else [*statement.body, *statement.orelse]
        return _is_plain(statement.test) and all(map(_is_idle, within))
    if isinstance(statement, ast.Expr):
        calls = [each for each in ast.walk(statement) if isinstance(each, ast.Call)]
        return all(_called(each) in _IDLE_CALLS for each in calls)
    return isinstance(statement, ast.Pass | ast.Continue)


def _is_plain(test: ast.expr) -> bool:
    """Whether what it tests can be changed by others only."""
    calls = [each for each in ast.walk(test) if isinstance(each, ast.Call)]
    return all(_called(each) in ("done", "ok", "is_set", "all", "any") for each in calls) and not any(
        isinstance(each, ast.NamedExpr | ast.Await | ast.Yield) for each in ast.walk(test)
    )


def _called(call: ast.Call) -> str:
    return getattr(call.func, "attr", getattr(call.func, "id", ""))
