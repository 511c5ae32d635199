"""The stacks of the threads at one moment, and what of rclpy is found in them."""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Iterable
    from types import FrameType
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
