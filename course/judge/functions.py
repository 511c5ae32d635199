"""Checks by a function of the lesson's folder, for what YAML cannot say."""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import importlib.util
import re
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future, InvalidStateError
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from course.judge.evidence import MET, Evidence, Observation, missed
from course.judge.looking import dead_nodes, no_messages
from course.lessons.lesson import LessonFolder
from launcher.profile.steps.checks import PublishCheck, PythonCheck
from launcher.profile.steps.expressions import Drawn
from robot.topics import TF_STATIC
from text.i18n import decimal
from text.sentences import InLanguages, say

T = TypeVar("T")
_POINT = re.compile(r"(?<=\d)\.(?=\d)")
AT_MOST_S = 2.0
"""How long a function may take."""


class LessonFaultError(Exception):
    """The lesson itself is at fault."""


@dataclass(frozen=True)
class SeenMessages:
    """What a function of a lesson is given."""

    messages: Mapping[str, list[tuple[float, Mapping[str, Any]]]]
    """Of each topic, when each message came (unix time) and its fields, oldest first."""
    values: Mapping[str, Drawn]
    logs: Mapping[str, list[str]]
    """Of each node of the profile, the lines it has logged or printed."""
    logged: Mapping[str, list[tuple[float, Mapping[str, str]]]]
    """Of each node, what it has given to a logger of ROS: when (unix time), `severity` and `text`.

    It is read from what the node writes: a message on /rosout lives for 10 s only, and on a busy
    machine whoever subscribes may be found later than that.
    """


def load(folder: Path, named: str) -> Callable[[SeenMessages], object]:
    """Return a function `checks.py:name` of a lesson's folder. Raises LessonFaultError."""
    file, _, name = named.partition(":")
    path = folder / file
    spec = importlib.util.spec_from_file_location(f"_lesson_{path.stem}", path)
    if spec is None or spec.loader is None or not path.is_file():
        raise LessonFaultError(say("there is no file {path}", path=str(path)))
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        raise LessonFaultError(_fault(path, error)) from error
    function = getattr(module, name, None)
    if not callable(function):
        raise LessonFaultError(say("{path} has no function {name}", path=str(path), name=name))
    found: Callable[[SeenMessages], object] = function
    return found


async def python(check: PythonCheck, evidence: Evidence, since_s: float) -> Observation:
    """Whatever the function says; it is asked again whenever something comes."""
    function = evidence.functions.get(check.python) or await _loaded(evidence.folder, check.python)
    if check.over is not None:
        await evidence.let_pass(check.over)
    deadline_s = time.monotonic() + check.within
    while (said := await _asked(function, check, evidence, since_s)) is not None:
        left_s = deadline_s - time.monotonic()
        if left_s <= 0 or evidence.ended:
            return _complaint(said, check, evidence)
        await evidence.wait(min(left_s, 0.2))
    return MET


async def _asked(
    function: Callable[[SeenMessages], object], check: PythonCheck, evidence: Evidence, since_s: float
) -> object:
    lines = {node: evidence.lines(node, since_s) for node in evidence.nodes}
    since = {topic: since_s or evidence.fresh_s(topic, latched=topic == TF_STATIC) for topic in check.topics}
    seen = SeenMessages(
        {topic: [(each.received_s, each.value) for each in evidence.messages(topic, since_s)]
         for topic, since_s in since.items()},
        evidence.values,
        {node: [line.text for line in of_it] for node, of_it in lines.items()},
        {node: [(line.time_s, {"severity": line.severity.value, "text": line.text}) for line in of_it if line.logger]
         for node, of_it in lines.items()},
    )  # fmt: skip
    try:
        return await _in_thread(partial(function, seen), check.python)
    except LessonFaultError:
        raise
    except Exception as error:
        raise LessonFaultError(_fault(evidence.folder / check.python.partition(":")[0], error)) from error


async def preloaded(lesson: LessonFolder) -> dict[str, Callable[[SeenMessages], object]]:
    """Load the functions of a lesson's checks, by the name that checks give them.

    One that cannot be loaded is left out: the check whose turn it is will say why.
    """
    found: dict[str, Callable[[SeenMessages], object]] = {}
    for step in lesson.steps:
        for check in step.checks:
            for each in (check, *(check.then if isinstance(check, PublishCheck) else ())):
                if isinstance(each, PythonCheck) and each.python not in found:
                    with contextlib.suppress(LessonFaultError):
                        found[each.python] = await _loaded(lesson.path, each.python)
    return found


async def _loaded(folder: Path, named: str) -> Callable[[SeenMessages], object]:
    """Load a function, also from a file that takes for ever. Raises LessonFaultError."""
    return await _in_thread(partial(load, folder, named), named)


async def _in_thread(function: Callable[[], T], named: str) -> T:
    """Call a function in a thread that holds up nothing, not even the end of this process.

    Raises:
        LessonFaultError: if it takes too long; it is ended then, as far as it is Python code.
    """
    called: Future[T] = Future()

    def call() -> None:
        with contextlib.suppress(InvalidStateError):  # Nobody waits for it any more.
            try:
                called.set_result(function())
            except Exception as error:  # noqa: BLE001 - raised where it is awaited
                called.set_exception(error if not isinstance(error, StopIteration) else RuntimeError("StopIteration"))
            except BaseException as error:  # noqa: BLE001 - it would end more than this call
                called.set_exception(RuntimeError(type(error).__name__))

    thread = threading.Thread(target=call, name="lesson-function", daemon=True)
    thread.start()
    try:
        return await asyncio.wait_for(asyncio.wrap_future(called), AT_MOST_S)
    except asyncio.TimeoutError as error:
        raise LessonFaultError(say("{function} takes longer than {n} s", function=named, n=AT_MOST_S)) from error
    finally:
        if thread.is_alive() and called.cancelled():
            exits = ctypes.py_object(SystemExit)
            ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident or 0), exits)


def _complaint(said: object, check: PythonCheck, evidence: Evidence) -> Observation:
    for topic, type_name in check.topics.items():
        row = evidence.topic(topic)
        if row is None or not row.publishers:
            return no_messages(evidence, topic, type_name)
    if not isinstance(said, dict):
        return missed(str(said), dead_nodes(evidence))
    # The decimal point that Python writes, as each language has it.
    texts = {code: _POINT.sub(decimal(".", code), text) for code, text in said.items() if isinstance(text, str)}
    return missed(InLanguages(texts), dead_nodes(evidence))


def _fault(path: Path, error: BaseException) -> str:
    trace = error.__traceback__
    line = 0
    while trace is not None:
        if Path(trace.tb_frame.f_code.co_filename) == path:
            line = trace.tb_lineno
        trace = trace.tb_next
    return say("{path}:{line}: {kind}: {text}", path=str(path), line=line, kind=type(error).__name__, text=str(error))
