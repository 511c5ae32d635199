"""The stacks of the threads at one moment, what of rclpy is found in them, and what keeps a node from its work."""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from types import CodeType, FrameType
    from typing import Any

EXECUTORS = "/rclpy/executors.py"
"""What calls the callbacks."""
RCLPY = "/rclpy/__init__.py"
CLIENT = "/rclpy/client.py"
ACTION_CLIENT = "/rclpy/action/client.py"
ACTION_SERVER = "/rclpy/action/server.py"
TASK = "/rclpy/task.py"
POOL = "/concurrent/futures/thread.py"
"""What calls those of a `MultiThreadedExecutor`."""
_DEBUGGERS = ("/bdb.py", "/pdb.py", "/pydevd.py")


class Thread:
    """One thread; of its frames the innermost is the first."""

    def __init__(self, number: int, stack: FrameType, folder: str) -> None:
        self.number = number
        self.frames = list(_down(stack))
        self.own = [frame for frame in self.frames if is_in(frame, folder)]
        """Those of the learner's own program."""
        self.debugged = any(is_of(frame, *_DEBUGGERS) for frame in self.frames)
        self.in_pool = any(is_of(frame, POOL) for frame in self.frames)

    @property
    def spins(self) -> bool:
        return any(
            is_of(frame, EXECUTORS) or (is_of(frame, RCLPY) and frame.f_code.co_name.startswith("spin"))
            for frame in self.frames
        )

    @property
    def executors(self) -> list[Any]:
        kind = class_of("rclpy.executors", "Executor")
        of = (frame.f_locals.get("self") for frame in self.frames if is_of(frame, EXECUTORS))
        return [each for each in of if isinstance(each, kind)]

    @property
    def pool(self) -> object:
        """The pool that it is one of; None if it is none."""
        for frame in self.frames:
            if frame.f_code.co_name == "_worker" and is_of(frame, POOL):
                reference = frame.f_locals.get("executor_reference")
                return reference() if callable(reference) else None
        return None

    def is_callback(self, frame: FrameType) -> bool:
        """Whether an executor has called it, or a future whose answer the executor has taken in."""
        if frame.f_back is None or not is_of(frame.f_back, EXECUTORS, TASK):
            return False
        return any(is_of(each, EXECUTORS) for each in _down(frame))

    def is_within(self, frame: FrameType, outer: FrameType) -> bool:
        """Whether a frame of this thread is another, or is called by it."""
        return self.frames.index(frame) <= self.frames.index(outer)

    def entities_around(self, frame: FrameType) -> list[object]:
        """Return the timers, subscriptions and so on whose callbacks this frame is in.

        The innermost is the first; there are several if one of them spins.
        """
        return [
            each.f_locals.get("entity")
            for each in _down(frame)
            if each.f_code.co_name == "handler" and is_of(each, EXECUTORS)
        ]

    def entity_around(self, frame: FrameType) -> object:
        """Return the innermost of them, or None."""
        return next(iter(self.entities_around(frame)), None)


def _down(stack: FrameType | None) -> Iterable[FrameType]:
    while stack is not None:
        yield stack
        stack = stack.f_back


def is_of(frame: FrameType, *files: str) -> bool:
    """Whether it belongs to one of these files of rclpy or of Python."""
    return frame.f_code.co_filename.endswith(files)


def is_in(frame: FrameType, folder: str) -> bool:
    """Whether it belongs to a file of this folder."""
    return frame.f_code.co_filename.rpartition("/")[0] == folder


def class_of(module: str, name: str) -> Any:  # noqa: ANN401
    """Return a class for `isinstance`; one that nothing is of, where it has not been imported."""
    return getattr(sys.modules.get(module), name, ())


def awaits_calls(node: Any) -> bool:  # noqa: ANN401 - a node of rclpy
    """Whether a node has timers, subscriptions, clients or services of its learner's."""
    own = ("timers", "subscriptions", "clients")
    try:
        # rclpy names its own services by the node's name alone, others by the whole.
        everybodys = (f"{node.get_name()}/", f"{node.get_fully_qualified_name()}/")
        served = (each.srv_name for each in node.services)
        return any(any(True for _ in getattr(node, kind)) for kind in own) or not all(
            name.startswith(everybodys) for name in served
        )
    except Exception:  # noqa: BLE001 - its constructor is not through: nothing can be said
        return False


DEADLOCK_S = 3.0
"""How long it may last if it cannot end by itself, such as waiting for the answer to a `call`."""
STUCK_S = 30.0
"""How long any other callback may run before it counts as stuck; it is reported if it goes on."""
UNSPUN_S = 15.0
"""How long the main thread may take before it spins, or a service before somebody offers it."""
_UNOFFERED_LOOKS = 2
"""What nobody has offered at so many looks was not offered when it was asked."""


class Finding:
    """A callback that runs, a wait, a main thread that has not spun yet, a node left alone."""

    def __init__(
        self, key: object, name: str, place: tuple[str, int], waits_in: str, bound_s: float, subject: object = None
    ) -> None:
        """`key`: the same as long as it is the same finding; `subject`: about the same thing."""
        self.key = key
        self.name = name
        self.file, self.line = place
        self.waits_in = waits_in
        """What it waits in, or else what is wrong: see `launcher.faults.crash.MENDS`."""
        self.bound_s = bound_s
        self.subject = subject
        self.awaited: tuple[str, str] | None = None
        """`service` or `action`, and the name of it."""
        self.offered = False
        """Whether somebody offers what it waits for."""
        self.long: CodeType | None = None
        """The callback, if that it runs is reported early: nothing else is done meanwhile."""
        self.reported_in = ""
        self.proof: Callable[[], bool] = lambda: True
        """Asked once it has lasted: whether it can be nothing else."""
        self.ran_s = 0.0
        self.stuck = False
        self.unoffered_looks = 0

    @classmethod
    def at(cls, kind: str, frame: FrameType, own: FrameType, waits_in: str, bound_s: float) -> Finding:
        """Return what is found in a frame, of which the learner's own frame `own` is reported."""
        place = own.f_code.co_filename, own.f_lineno
        return cls((kind, frame), own.f_code.co_name, place, waits_in, bound_s)

    def follow(self, earlier: Finding | None, passed_s: float) -> None:
        """Take over what was known of it at the look before."""
        if earlier is not None and earlier.subject is self.subject:
            self.ran_s, self.stuck = earlier.ran_s + passed_s, earlier.stuck
            if self.waits_in == LOST != earlier.waits_in:
                self.stuck = False  # It is reported again, in other words.
            self.unoffered_looks = earlier.unoffered_looks
        self.unoffered_looks += self.awaited is not None and not self.offered
        if self.offered and not self._was_asked_in_vain:
            self.ran_s, self.stuck = 0.0, False

    @property
    def _was_asked_in_vain(self) -> bool:
        return self.waits_in == LOST and self.unoffered_looks >= _UNOFFERED_LOOKS

    def has_lasted(self) -> bool:
        """Whether it has lasted for too long, and is proven."""
        if self.stuck or self.ran_s < self.bound_s:
            return False
        self.stuck = self.proof()
        # What is not now is looked at once more when so long has passed again.
        self.ran_s = self.ran_s if self.stuck else 0.0
        return self.stuck


NOBODY, LOST = "nobody", "lost"
"""Nobody offers it; somebody does, but not when it was asked."""
