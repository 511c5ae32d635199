"""A callback that does not return, in words: since when, in which line, and what to write."""

from __future__ import annotations

import linecache
import time
from typing import TYPE_CHECKING, Any

from launcher.faults.telling import CALLBACK
from launcher.status import STUCK, NodeFault
from text.i18n import N_
from text.plain import plain
from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Mapping

MENDS = {
    "call": N_(
        "call() waits for an answer that only this very thread can take in. In a callback:"
        " future = client.call_async(request), and future.add_done_callback(self.on_answer), where"
        " future.result() is the answer."
    ),
    "spin": N_(
        "Spinning within a callback waits for itself. Have the answer called back:"
        " client.call_async(request).add_done_callback(self.on_answer), where future.result() is"
        " the answer."
    ),
    "rate": N_(
        "A Rate sleeps until its timer has run, which only this very thread can do: put what is"
        " done at each turn into a callback of create_timer."
    ),
    "goal": N_(
        "It waits for an answer that only this very thread can take in. In a callback:"
        " client.send_goal_async(goal).add_done_callback(self.on_goal), and there"
        " future.result().get_result_async().add_done_callback(self.on_result)."
    ),
    "loop": N_(
        "The loop waits for an answer that only this very thread can take in, once the callback has"
        " returned. Have it called back: client.call_async(request)"
        ".add_done_callback(self.on_answer), where future.result() is the answer."
    ),
    "event": N_(
        "What this waits for only another callback can bring, and none is called before this one"
        " has returned. Have the answer called back: client.call_async(request)"
        ".add_done_callback(self.on_answer), and go on there."
    ),
    "lock": N_(
        "Nobody is there to release this lock: the same thread has it already, or nobody has"
        " released it. Write: with lock: … (which releases it), and threading.RLock() if whoever"
        " has it may take it again."
    ),
    "group": N_(
        "This waits for an answer that its callback group takes in only after this callback. Have"
        " it called back: client.call_async(request).add_done_callback(self.on_answer); or give the"
        " client another group: create_client(…, callback_group=MutuallyExclusiveCallbackGroup())."
    ),
    "pool": N_(
        "Every thread of the executor waits for an answer that one of them would have to take in."
        " Have it called back: client.call_async(request).add_done_callback(self.on_answer)."
    ),
    "main": N_("Until the program comes to rclpy.spin(node), nothing is called: let a timer do what stands here."),
    "main_call": N_(
        "call() waits for an answer that nobody takes in before rclpy.spin. Here: future ="
        " client.call_async(request), and rclpy.spin_until_future_complete(node, future)."
    ),
    "main_loop": N_(
        "The loop waits for an answer that nobody takes in before rclpy.spin. In its place:"
        " rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)."
    ),
    "main_rate": N_(
        "A Rate sleeps until its timer has run, and before rclpy.spin none does: put what is done"
        " at each turn into a callback of create_timer."
    ),
    "forsaken": N_(
        "rclpy.spin_until_future_complete and rclpy.spin_once take the node out of the executor"
        " that spins it. In a callback: client.call_async(request)"
        ".add_done_callback(self.on_answer), where future.result() is the answer."
    ),
    "": N_("Until a callback returns, the node hears nothing: let a timer do the waiting."),
}
"""By what a callback waits in, as `launcher.callback_watch` names it."""

AWAITED = {
    ("nobody", "service"): N_(
        "It waits for the service {name}, which nobody offers: does the node that should run, and"
        " is the name right? Ask before: client.wait_for_service(timeout_sec=5.0) says whether it"
        " is there; then client.call_async(request).add_done_callback(self.on_answer)."
    ),
    ("nobody", "action"): N_(
        "It waits for the action {name}, which nobody offers: does the node that should run, and"
        " is the name right? Ask before: client.wait_for_server(timeout_sec=5.0) says whether it"
        " is there; then client.send_goal_async(goal).add_done_callback(self.on_goal)."
    ),
    ("lost", "service"): N_(
        "It waits for an answer of the service {name} that does not come: nobody offered it when"
        " the request was sent, or whoever did has ended since. Wait before:"
        " client.wait_for_service(timeout_sec=5.0); then"
        " client.call_async(request).add_done_callback(self.on_answer)."
    ),
    ("lost", "action"): N_(
        "It waits for an answer of the action {name} that does not come: nobody offered it when"
        " the goal was sent, or whoever did has ended since. Wait before:"
        " client.wait_for_server(timeout_sec=5.0); then"
        " client.send_goal_async(goal).add_done_callback(self.on_goal)."
    ),
}
"""By why an answer does not come, and of what."""


STUCK_SINCE = N_("{name} has been stuck since {time}")
FORSAKEN = N_("nothing of the node {name} is called any more: no executor spins it")
STILL_RUNS = N_("{name} still runs after {seconds} s")


def held_by(fault: NodeFault) -> str:
    """Return the callback that a fault says not to return; empty for other faults."""
    words = fault.exception
    if isinstance(words, Words) and words.template in (STUCK_SINCE, STILL_RUNS):
        return str(words.values["name"])
    return ""


def stuck_in(told: Mapping[str, Any]) -> tuple[NodeFault, bool] | None:
    """Return the callback that a process tells of, and whether it has gone on meanwhile."""
    seen = told.get(CALLBACK)
    if not isinstance(seen, dict):
        return None
    try:
        file, line, since_s = str(seen["file"]), int(seen["line"]), float(seen["since_s"])
        name, waits_in = str(seen["name"]), str(seen["waits_in"])
        since = time.strftime("%H:%M:%S", time.localtime(since_s))
    except (KeyError, OverflowError, TypeError, ValueError):
        return None
    source = linecache.getline(file, line).strip()
    linecache.clearcache()
    words = say(STUCK_SINCE, name=name, time=since)
    if waits_in == "forsaken":
        words = say(FORSAKEN, name=name)
    meaning = _meaning(waits_in, seen.get("awaited"))
    fault = NodeFault(STUCK, file, line, 0, plain(source), words, meaning)
    return fault, seen.get("over") is True


def _meaning(waits_in: str, awaited: object) -> Words:
    if isinstance(awaited, list) and len(awaited) == 2:
        kind, name = map(str, awaited)
        if (waits_in, kind) in AWAITED:
            return say(AWAITED[waits_in, kind], name=name)
    return say(MENDS.get(waits_in, MENDS[""]))
