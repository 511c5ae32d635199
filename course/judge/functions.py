"""Checks by a function of the lesson's folder, for what YAML cannot say."""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import importlib.util
import re
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from course.judge.evidence import MET, Observation, missed
from course.judge.missing import dead_nodes, no_messages
from launcher.profile.steps.checks import PublishCheck, PythonCheck
from robot.topics import TF_STATIC
from text.i18n import decimal
from text.sentences import InLanguages, say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from course.judge.evidence import Evidence
    from course.lessons.lesson import LessonFolder
    from launcher.profile.steps.expressions import Drawn

T = TypeVar("T")
_POINT = re.compile(r"(?<=\d)\.(?=\d)")
AT_MOST_S = 2.0
"""How long a function may take."""


class LessonFaultError(Exception):
    """The lesson itself is at fault; `words` says where."""

    def __init__(self, words: str) -> None:
        super().__init__(str(words))
        self.words = words


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
        await evidence.until(lambda: None, check.over)
    deadline_s = asyncio.get_running_loop().time() + check.within
    while True:
        said = await _asked(function, check, evidence, since_s)
        if said is None:
            return MET
        left_s = deadline_s - asyncio.get_running_loop().time()
        if left_s <= 0 or evidence.ended:
            return _complaint(said, check, evidence)
        await evidence.wait(min(left_s, 0.2))


async def _asked(
    function: Callable[[SeenMessages], object], check: PythonCheck, evidence: Evidence, since_s: float
) -> object:
    lines = {node: evidence.lines(node, since_s) for node in evidence.nodes}
    seen = SeenMessages(
        messages={
            topic: [
                (each.time_s, each.value)
                for each in evidence.messages(topic, since_s or evidence.fresh_s(topic, latched=topic == TF_STATIC))
            ]
            for topic in check.topics
        },
        values=evidence.values,
        logs={node: [line.text for line in of_it] for node, of_it in lines.items()},
        logged={
            node: [
                (line.time_s, {"severity": line.severity.value, "text": line.text}) for line in of_it if line.logger
            ]
            for node, of_it in lines.items()
        },
    )
    try:
        return await asyncio.wait_for(_in_thread(lambda: function(seen)), AT_MOST_S)
    except asyncio.TimeoutError as error:
        words = say("{function} takes longer than {n} s", function=check.python, n=AT_MOST_S)
        raise LessonFaultError(words) from error
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
    try:
        return await asyncio.wait_for(_in_thread(lambda: load(folder, named)), AT_MOST_S)
    except asyncio.TimeoutError as error:
        words = say("{function} takes longer than {n} s", function=named, n=AT_MOST_S)
        raise LessonFaultError(words) from error


async def _in_thread(function: Callable[[], T]) -> T:
    """Call a function in a thread that holds up nothing, not even the end of this process."""
    loop = asyncio.get_running_loop()
    called: asyncio.Future[T] = loop.create_future()

    def settle(act: Callable[[], None]) -> None:
        if not called.done():
            act()

    def call() -> None:
        try:
            result = function()
        except (StopIteration, SystemExit, KeyboardInterrupt) as error:
            # A future refuses the first, and the others would end more than this call.
            problem: Exception = RuntimeError(type(error).__name__)
            act = lambda: called.set_exception(problem)  # noqa: E731
        except Exception as error:  # noqa: BLE001 - raised where it is awaited
            failure = error
            act = lambda: called.set_exception(failure)  # noqa: E731
        else:
            act = lambda: called.set_result(result)  # noqa: E731
        with contextlib.suppress(RuntimeError):  # The loop may be closed by then.
            loop.call_soon_threadsafe(settle, act)

    thread = threading.Thread(target=call, name="lesson-function", daemon=True)
    thread.start()
    try:
        return await called
    finally:
        if thread.is_alive() and (called.cancelled() or not called.done()):
            _interrupt(thread)


def _interrupt(thread: threading.Thread) -> None:
    """Raise SystemExit in a thread that goes on for ever; it takes effect in Python code only."""
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident or 0), ctypes.py_object(SystemExit))


def _complaint(said: object, check: PythonCheck, evidence: Evidence) -> Observation:
    for topic, type_name in check.topics.items():
        row = evidence.topic(topic)
        if row is None or not row.publishers:
            return no_messages(evidence, topic, type_name)
    seen = InLanguages(_with_commas(said)) if isinstance(said, dict) else str(said)
    return missed(seen, dead_nodes(evidence))


def _with_commas(texts: Mapping[str, str]) -> dict[str, str]:
    """Return the texts with the decimal point that Python writes as their language has it."""
    return {
        code: _POINT.sub(decimal(".", code), text) if isinstance(text, str) else text for code, text in texts.items()
    }


def _fault(path: Path, error: BaseException) -> str:
    trace = error.__traceback__
    line = 0
    while trace is not None:
        if Path(trace.tb_frame.f_code.co_filename) == path:
            line = trace.tb_lineno
        trace = trace.tb_next
    return say("{path}:{line}: {kind}: {text}", path=str(path), line=line, kind=type(error).__name__, text=str(error))
