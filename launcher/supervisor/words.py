"""Sentences about how a node ended, and what it is waiting for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from launcher.processes.exit import UNSEEN, Exit
from launcher.processes.table import Process
from launcher.status import HALTED, NodeFault
from text.sentences import say

if TYPE_CHECKING:
    # Clients list processes by `who`, and need no pydantic for it.
    from launcher.profile.node import Node, Ready

NOT_EXECUTABLE, NOT_FOUND = 126, 127
NOT_FOUND_WORDS = "deck: command not found"
"""The beginning of a forked process's message that its command does not exist."""


class Seen(NamedTuple):
    """The state of a topic whose condition is not met, or that of a node's lifecycle."""

    types: tuple[str, ...]
    """The types of its publishers; for a lifecycle the one state."""
    rate_hz: float | None = None
    """The rate of its messages; None if it is not required or cannot be measured."""


def stopped_words(last: Exit | None) -> str:
    """How a node ended that was asked to stop; `last` is None if it had no process."""
    if last is not None and last.signal is not None:
        return say("stopped by {signal}", signal=last.signal)
    if last is not None and last.code:
        return say("stopped, exit code {code}", code=last.code)
    return say("stopped")


def suspended(pid: int) -> NodeFault:
    """What is wrong with a node of which a signal has suspended this process."""
    return NodeFault(
        HALTED,
        exception=say("suspended by a signal (SIGSTOP, pid {pid})", pid=pid),
        meaning=say("It does nothing until it gets SIGCONT: `kill -CONT {pid}`, or restart the node.", pid=pid),
    )


def end_words(end: Exit, plan: Node, last: str, *, asked: bool) -> str:
    """How a process ended, with its `last` line of output unless it was `asked` to end."""
    if end.clean:
        return say("ended")
    if end.code == NOT_FOUND and last.startswith(NOT_FOUND_WORDS) and not plan.is_forked:
        program = plan.argv()[0]
        if plan.optional:
            return say("{program} is not installed; the lesson continues without it", program=program)
        return say("{program} is not installed", program=program)
    if end == UNSEEN:
        return say("gone, nobody saw how it ended")
    if end.signal == "SIGINT":
        how = say("interrupted ({signal})", signal=end.signal)
    elif end.signal is not None:
        how = say("killed by {signal}", signal=end.signal)
    else:
        how = say("exit code {code}", code=end.code)
    # A killed process cannot say why: its last line is about something else.
    told = last and not asked and end.signal != "SIGKILL"
    return say("{how}: {last}", how=how, last=_short(last)) if told else how


def what(condition: Ready) -> str:
    """Describe the condition that is waited for."""
    if condition.topic:
        if condition.type:
            return say("publisher of {name} ({type})", name=condition.topic, type=condition.type)
        return say("publisher of {name}", name=condition.topic)
    if condition.service:
        return say("service {name}", name=condition.service)
    if condition.lifecycle:
        return say("{name} to be {state}", name=condition.node, state=condition.lifecycle)
    return say("node {name} in the graph", name=condition.node)


def instead(condition: Ready, seen: Seen) -> str:
    """Describe why the condition does not hold: another type or state, or too few messages."""
    types = ", ".join(seen.types)
    if condition.lifecycle:
        return say(
            "{name} is {state}, expected {wanted}", name=condition.node, state=types, wanted=condition.lifecycle
        )
    topic = condition.topic
    if condition.type and condition.type not in seen.types:
        return say("{name} is published as {types}, expected {type}", name=topic, types=types, type=condition.type)
    if seen.rate_hz is None:
        return say("the rate of {name} cannot be measured: {types} is not installed", name=topic, types=types)
    return say(
        "{name} arrives at {rate:.2g} Hz, expected {wanted:g} Hz",
        name=topic,
        rate=seen.rate_hz,
        wanted=condition.rate,
    )


def late(condition: Ready, seen: Seen | None, within_s: float) -> str:
    """Say that a node is not ready in time, and why."""
    why = lack(condition) if seen is None else instead(condition, seen)
    return say("not ready within {seconds:g} s: {why}", seconds=within_s, why=why)


def lack(condition: Ready) -> str:
    """Say what is missing after the wait has timed out."""
    if condition.topic:
        return say("nobody publishes {name}", name=condition.topic)
    if condition.service:
        return say("nobody serves {name}", name=condition.service)
    if condition.lifecycle:
        return say("{name} tells no state: it is not there, or has no lifecycle", name=condition.node)
    return say("node {name} is not in the graph", name=condition.node)


def left_undone(condition: Ready) -> str:
    """Say what is missing when a node ends, even cleanly; empty if it only had to appear."""
    if condition.topic:
        return say("ended by itself, but should still publish {name}", name=condition.topic)
    if condition.service:
        return say("ended by itself, but should still serve {name}", name=condition.service)
    if condition.lifecycle:
        return say("ended by itself, but should still be {state}", state=condition.lifecycle)
    return ""


def not_brought_up(transition: str, state: str, last: str) -> str:
    """Say that a node did not get where it should by its lifecycle; `last` is what it said last."""
    how = (
        say("{transition} failed, it is {state} now", transition=transition, state=state)
        if transition
        else say("it is {state}, from where it gets nowhere", state=state)
    )
    return say("{how}: {last}", how=how, last=_short(last)) if last else how


def who(left: Sequence[Process], most: int = 3) -> str:
    """List processes by number and name, at most `most` of them."""
    names = ", ".join(f"{process.pid} ({process.name})" for process in left[:most])
    return names if len(left) <= most else f"{names} …"


def _short(text: str, most: int = 160) -> str:
    return text if len(text) <= most else text[: most - 1] + "…"
