"""A main thread that does not come to spin a node which waits for that."""

from __future__ import annotations

import gc

from .finding import DEADLOCK_S, UNSPUN_S, Finding
from .stacks import class_of
from .waits import CALL, LOOP, RATE, waits_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .stacks import Thread

MAIN, MAIN_CALL, MAIN_RATE, MAIN_LOOP = "main", "main_call", "main_rate", "main_loop"
"""Where it is."""


def unspun(thread: Thread) -> list[Finding]:
    """Return where the main thread is if it has a node that waits for being spun."""
    if not thread.own or thread.debugged:
        return []
    own = thread.own[0]
    waits = {each.how: each for each in waits_of(thread) if each.own is own and not each.limited}
    for how, where in ((CALL, MAIN_CALL), (RATE, MAIN_RATE), (LOOP, MAIN_LOOP)):
        if how in waits and (how != LOOP or waits[how].client is not None):
            return [Finding.at("main", own, own, where, DEADLOCK_S)]
    node = class_of("rclpy.node", "Node")
    in_constructor = any(
        each.f_code.co_name == "__init__" and isinstance(each.f_locals.get("self"), node) for each in thread.frames
    )
    # The outermost: it stays, whatever it calls by turns.
    finding = Finding.at("main", thread.own[-1], own, MAIN, UNSPUN_S)
    finding.proof = lambda: _is_proven(in_constructor=in_constructor)
    return [finding]


def _is_proven(*, in_constructor: bool) -> bool:
    """Whether what has taken so long can be nothing else.

    No executor has ever spun, and there is a node with something to be called, or not yet whole.
    """
    node, executor = class_of("rclpy.node", "Node"), class_of("rclpy.executors", "Executor")
    everything = gc.get_objects()
    if any(isinstance(each, executor) and _has_spun(each) for each in everything):
        return False
    return in_constructor or any(isinstance(each, node) and awaits_calls(each) for each in everything)


def _has_spun(executor: object) -> bool:
    return getattr(executor, "_last_args", None) is not None


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
