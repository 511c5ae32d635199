"""Reading what a process has printed, where it has told nothing itself: its last traceback, a line of the log."""

from __future__ import annotations

import linecache
import os
import re
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from launcher.faults.rules.said import OF_ROS, TAKEN_ARGUMENTS, UNHEARD
from launcher.faults.telling import CALLBACK
from launcher.status import STUCK, NodeFault
from text.i18n import N_
from text.plain import plain
from text.sentences import Words, say

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


_BLOCKED = re.compile(
    r"(?:callback|обработчик) (?P<name>\S+) (?:still runs after|не закончил и через) "
    r"(?P<seconds>[\d.]+) [sс](?: (?:in|в) (?P<waits_in>\w+))?: "
    r"(?P<file>.+), (?:line|строка) (?P<line>\d+)"
)
"""What `launcher.callback_watch` writes."""
_UNHEARD = re.compile(r"(?P<words>nothing fills this buffer), .*: asked in (?P<file>.+), line (?P<line>\d+)")
"""What the Buffer of `bridges/tf2_ros` writes."""
_WARNINGS = (
    (r"incompatible QoS", N_("The QoS of publisher and subscription do not fit each other: nothing arrives.")),
    (
        r"Publisher already registered for (?:provided )?node name",
        N_("Two nodes have the same name: rename one of them."),
    ),
    (
        r"Callback returned an invalid type, it should return SetParameterResult",
        N_(
            "The callback of add_on_set_parameters_callback has to return"
            " SetParametersResult(successful=True), from rcl_interfaces.msg; without it no"
            " parameter changes."
        ),
    ),
)
"""Mistakes that show in a line of the log only, while the node runs on."""
BEGIN = "Traceback (most recent call last):"
_FRAME = re.compile(r'^\s*File "(.+)", line (\d+)(?:, in .*)?$')
_EXCEPTION = re.compile(r"^[A-Za-z_][\w.]*(?:Error|Exception|Interrupt|Exit|Warning)(: .*)?$")
_SYNTAX = ("SyntaxError", "IndentationError", "TabError")
_LONG_NUMBER = re.compile(r"(\d{4})\d{30,}(\.\d+)?")
"""Such as the limits of a float64, written out, that rclpy puts into its sentence on a list."""
_READS_ARGUMENTS = re.compile(r"\.parse(?:_known)?_args\s*\(|\bsys\.argv\b|\bgetopt\b")
_LAST_LINES = 8
_LONGEST, _LONGEST_LINE = 200, 1000


def crash_of(lines: Sequence[str], folder: str) -> NodeFault | None:
    """Return the fault that the last traceback among these lines tells of, None if there is none.

    Of its frames, the last one in a file of this folder counts, else the last one.
    """
    starts = [number for number, line in enumerate(lines) if line.strip() == BEGIN]
    begin = starts[-1] if starts else _syntax_without_traceback(lines)
    if begin is None:
        return None
    frames: list[tuple[str, int, str]] = []
    for number in range(begin, len(lines)):
        found = _FRAME.match(lines[number])
        if found:
            source = lines[number + 1].strip() if number + 1 < len(lines) else ""
            frames.append((found[1], int(found[2]), source))
    exceptions = [line.strip() for line in lines[begin:] if _EXCEPTION.match(line)]
    if not frames or not exceptions:
        return None
    exception = _LONG_NUMBER.sub(r"\1…", exceptions[-1])
    own = [frame for frame in frames if os.path.dirname(frame[0]) == folder] or frames  # noqa: PTH120
    file, line, source = own[-1]
    kind = "syntax" if exception.startswith(_SYNTAX) else "crash"
    return NodeFault(kind, file, line=line, source_line=source, exception=exception)


def _syntax_without_traceback(lines: Sequence[str]) -> int | None:
    """Return where a syntax error begins that Python reports without `Traceback`."""
    errors = [number for number, line in enumerate(lines) if line.startswith(_SYNTAX)]
    above = range(errors[-1], -1, -1) if errors else ()
    return next((number for number in above if _FRAME.match(lines[number])), None)


def warning_in(line: str, file: str) -> NodeFault | None:
    """Return the mistake in this file that a line of the log tells of while the node runs."""
    blocked = _BLOCKED.fullmatch(line)
    if blocked:
        words = say(STILL_RUNS, name=blocked["name"], seconds=blocked["seconds"])
        return _warning(blocked, words, MENDS.get(blocked["waits_in"] or "", MENDS[""]))
    unheard = _UNHEARD.fullmatch(line)
    if unheard:
        return _warning(unheard, unheard["words"], UNHEARD)
    meaning = warning_of(line)
    return NodeFault("warning", file, exception=line, meaning=meaning) if meaning else None


def _warning(found: re.Match[str], words: Words | str, mend: str) -> NodeFault:
    file, line = found["file"], int(found["line"])
    source = linecache.getline(file, line).strip()
    linecache.clearcache()
    return NodeFault("warning", file, line, 0, plain(source), words, say(mend))


def warning_of(line: str) -> Words | str:
    """Return the sentence for a line of the log, empty if there is none."""
    found = (sentence for pattern, sentence in _WARNINGS if re.search(pattern, line[:_LONGEST_LINE]))
    return next((say(sentence) for sentence in found), "")


def refused_arguments(lines: Sequence[str], file: str) -> NodeFault | None:
    """Return the fault if the last lines of a program say that it refuses an argument of ROS.

    Deck starts a node as `ros2 run` does: what stands after `--ros-args` is for rclpy.
    https://design.ros2.org/articles/ros_command_line_arguments.html
    """
    refused = (line for line in reversed(lines[-_LAST_LINES:]) if re.search(r"\berror:", line, re.IGNORECASE))
    line = next((each for each in refused if re.search(OF_ROS, each)), None)
    if line is None:
        return None
    try:
        program = Path(file).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        program = []
    reads = [number for number, each in enumerate(program, 1) if _READS_ARGUMENTS.search(each)]
    number = reads[-1] if reads else 0
    source = plain(program[number - 1].strip()[:_LONGEST]) if number else ""
    return NodeFault("crash", file, number, 0, source, plain(line.strip()[:_LONGEST]), say(TAKEN_ARGUMENTS))
