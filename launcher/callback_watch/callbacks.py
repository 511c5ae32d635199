"""Callbacks that do not return, and waits for what cannot come."""

from __future__ import annotations

import sys
import threading

from .stacks import ACTION_SERVER, DEADLOCK_S, LOST, NOBODY, STUCK_S, UNSPUN_S, Finding, awaits_calls, is_of
from .waits import CALL, EVENT, LOCK, LOOP, RATE, SPIN, awaiting, is_offered, is_told, name_of, pending, waits_of

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Iterable
    from types import FrameType
    from typing import Any

    from .stacks import Thread
    from .waits import Wait

GOAL, GROUP, POOL = "goal", "group", "pool"
"""An action's call; what keeps the answer from one that runs in a pool."""
_REPORTED = (CALL, SPIN, RATE)
WITHOUT_ROS = (EVENT, LOCK, LOOP)


class Look:
    """All threads at one moment, and what they wait for."""

    def __init__(self, threads: list[Thread], folder: str) -> None:
        self.threads = [thread for thread in threads if not thread.debugged]
        self._all = threads
        self.executors = list({id(each): each for one in threads for each in one.executors}.values())
        self.waits = {thread.number: waits_of(thread) for thread in self.threads}
        self.awaiting = [each for one in self.executors for each in awaiting(one, folder)]
        for wait in self.all_waits:
            if wait.client is None and not wait.limited:
                self._look_for_answer(wait)

    @property
    def all_waits(self) -> list[Wait]:
        return [*self.awaiting, *(wait for waits in self.waits.values() for wait in waits)]

    def findings(self) -> list[Finding]:
        """Return what may be stuck."""
        asked = [(each, one) for each in self.all_waits if (one := unoffered(each, self))]
        vain = {wait for wait, finding in asked if not finding.offered}
        """Waits for what nobody offers: that is the reason, whatever else there is."""
        deadlocked = {wait: finding for wait, finding in self._deadlocked() if wait not in vain}
        found = [*deadlocked.values()]
        for thread in self.threads:
            found += self._callbacks(thread, vain) if not thread.in_pool else []
        itself = {
            wait
            for thread in self.threads
            for wait in self.waits[thread.number]
            if self._waits_for_itself(wait, thread)
        }
        return found + [
            finding for wait, finding in asked if wait in vain or not (wait in deadlocked or wait in itself)
        ]

    def is_beside(self, wait: Wait) -> bool:
        """Whether a wait is that of a thread of the learner's own, beside the node's."""
        threads = (each for each in self.threads if each.number == wait.thread)
        main = threading.main_thread().ident
        return any(not (each.spins or each.in_pool or each.number == main) for each in threads)

    def _look_for_answer(self, wait: Wait) -> None:
        """Find the answer that would end a wait for an event, or for something to change."""
        if wait.how not in (EVENT, LOOP):
            return
        for client in self._clients():
            for future in pending(client):
                held = wait.entity is not None and holder(client) is wait.entity
                if is_told(wait.awaited, future) if wait.how == EVENT else held:
                    wait.future, wait.client = future, client
                    return

    def _clients(self) -> list[Any]:
        nodes = [node for each in self.executors for node in tuple(each._nodes)]  # noqa: SLF001
        return [one for node in nodes for one in (*node.clients, *node.waitables)]

    def _callbacks(self, thread: Thread, vain: set[Wait]) -> list[Finding]:
        """Return what an executor's only thread runs."""
        found = []
        for frame in thread.own:
            if not thread.is_callback(frame):
                continue
            entity = thread.entity_around(frame)
            # What spins it has no entity, nor has an action's execution.
            waits = [
                each
                for each in self.waits[thread.number]
                if each.entity is entity and thread.is_within(each.own, frame)
            ]
            proven = [each for each in waits if self._waits_for_itself(each, thread)]
            wait = next(iter(proven or waits), None)
            kind = told_as(wait) if wait is not None and proven else ""
            finding = Finding.at("runs", frame, thread.own[0], kind, STUCK_S)
            finding.name = frame.f_code.co_name
            if proven:
                # That long from when it is so, not from when the callback was called.
                finding.bound_s, finding.subject = DEADLOCK_S, proven[0].frame
            if vain.intersection(waits):
                finding.bound_s = float("inf")
            if wait is not None and wait.how in _REPORTED and not wait.limited:
                finding.reported_in = wait.how
            if finding.reported_in or not carries_out_a_goal(frame):
                finding.long = frame.f_code
            found.append(finding)
        return found

    def _waits_for_itself(self, wait: Wait, thread: Thread) -> bool:
        """Whether a callback of an executor's only thread waits for what nobody else brings."""
        if wait.limited or thread.in_pool or not thread.spins:
            return False
        if wait.how == RATE:
            return True
        if wait.spins:
            around = thread.entities_around(wait.own)
            if wait.client is None:
                return wait.how == SPIN and bool(around)
            return any(holder(wait.client) is each for each in around)
        if wait.client is not None:
            return not self._is_taken_in_beside(wait.client, thread)
        return wait.how in WITHOUT_ROS and len(self._all) == 1

    def _is_taken_in_beside(self, client: object, thread: Thread) -> bool:
        """Whether another thread spins the node of a client."""
        others = (each for each in self._all if each is not thread)
        executors = (one for each in others for one in each.executors)
        nodes = (node for one in executors for node in tuple(one._nodes))  # noqa: SLF001
        return any(client is one for node in nodes for one in (*node.clients, *node.waitables))

    def _deadlocked(self) -> Iterable[tuple[Wait, Finding]]:
        """Yield those in a pool, and coroutines, that wait for each other, or for themselves."""
        waiting = [
            wait
            for thread in self.threads
            if thread.in_pool
            for wait in self.waits[thread.number]
            if not wait.limited
        ]
        helpless = all(each.in_pool or each.spins for each in self._all)
        bound = [each for each in waiting if helpless or each.how not in WITHOUT_ROS or each.client]
        asking = [each for each in (*waiting, *self.awaiting) if each.client is not None]
        for each in {*bound, *asking}:
            of_pool = {one.thread for one in bound if one.pool is each.pool and needs_others(one)}
            if each.client is not None and _comes_round(each, asking):
                why = SPIN if each.how == SPIN else GROUP
            elif each.pool is not None and len(of_pool) >= each.pool._max_workers:  # noqa: SLF001
                why = POOL
            else:
                continue
            yield each, Finding.at("waits", each.frame, each.own, why, DEADLOCK_S)


def needs_others(wait: Wait) -> bool:
    """Whether another thread has to take in the answer: not one that spins can itself."""
    return not wait.spins or wait.client is None or holder(wait.client) is not None


def _comes_round(first: Wait, waiting: list[Wait]) -> bool:
    """Whether what keeps an answer back waits itself, and so on, without an end."""
    by_entity = {id(each.entity): each for each in waiting if each.entity is not None}
    met: set[int] = set()
    now: Wait | None = first
    while now is not None and (kept := holder(now.client)) is not None:
        if id(kept) in met:
            return True
        met.add(id(kept))
        now = by_entity.get(id(kept))
    return False


def holder(client: object) -> object:
    """Return what has the callback group that would take in an answer; None if it is free."""
    return getattr(getattr(client, "callback_group", None), "_active_entity", None)


def unoffered(wait: Wait, look: Look) -> Finding | None:
    """Return the wait for a service or action that nobody offers, or did when it was asked."""
    offered = is_offered(wait.client) if wait.client is not None else None
    if offered is None or (offered and (wait.limited or wait.future is None)):
        return None
    again = wait.limited or wait.future is None
    if again and look.is_beside(wait):
        return None
    frame = _outermost(wait, look) if wait.limited else wait.frame
    kind = LOST if offered else NOBODY
    finding = Finding.at("answer", frame, wait.own, kind, UNSPUN_S if again else DEADLOCK_S)
    finding.subject = wait.client if again else wait.future
    finding.awaited, finding.offered = name_of(wait.client), offered
    return finding


def _outermost(wait: Wait, look: Look) -> FrameType:
    """Return the frame that stays if the wait is begun anew by turns."""
    for thread in look.threads:
        if wait.own in thread.own:
            around = [each for each in thread.own if thread.entity_around(each) is wait.entity]
            return around[-1]
    return wait.own


def carries_out_a_goal(callback: FrameType) -> bool:
    """Whether it is an action's, and holds nothing up: that may take long.

    Nothing is held up if goals cannot be cancelled and the node has nothing else to be called.
    """
    caller = callback.f_back
    frames = [each for each in (caller, caller and caller.f_back) if each is not None]
    servers = [each.f_locals.get("self") for each in frames if is_of(each, ACTION_SERVER)]
    refuses = getattr(sys.modules.get("rclpy.action.server"), "default_cancel_callback", None)
    return any(
        getattr(server, "_cancel_callback", None) is refuses and not awaits_calls(getattr(server, "_node", None))
        for server in servers
    )


def told_as(wait: Wait) -> str:
    """Return the name of what is to be written in its place."""
    if wait.how == CALL and not hasattr(wait.client, "srv_name"):
        return GOAL
    return EVENT if wait.how == LOOP and wait.client is None else wait.how
