"""Looking at the threads of a learner's program, and telling what is found."""

from __future__ import annotations

import gc
import json
import linecache
import os
import sys
import threading
import time
import weakref

from .callbacks import Look
from .stacks import DEADLOCK_S, EXECUTORS, RCLPY, UNSPUN_S, Finding, Thread, awaits_calls, class_of, is_of
from .waits import CALL, LOOP, RATE, waits_of

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from collections.abc import Iterable
    from types import CodeType
    from typing import Any

FORSAKEN = "forsaken"
_SPINS = ("spin_until_future_complete(", "spin_once(")


class Homes:
    """Which executor each node is spun by.

    `rclpy.spin_until_future_complete(node, …)` and `rclpy.spin_once` take a node into the global
    executor, by which it leaves its own, and then out of that.
    """

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._of: weakref.WeakKeyDictionary[Any, weakref.ref[Any]] = weakref.WeakKeyDictionary()
        self._searched: weakref.WeakSet[Any] = weakref.WeakSet()

    def findings(self, look: Look) -> list[Finding]:
        """Return the nodes that have been taken out of an executor that spins on."""
        endless = list(_endless(look))
        for executor in endless:
            nodes = tuple(executor._nodes)  # noqa: SLF001
            self._of.update((node, weakref.ref(executor)) for node in nodes)
            if not nodes and executor not in self._searched:
                self._searched.add(executor)
                self._search(executor)
        found = []
        for node, reference in tuple(self._of.items()):
            now, home = node.executor, reference()
            if home not in endless or now is home or now in look.executors:
                continue
            if any(node in each._nodes for each in (home, now) if each is not None):  # noqa: SLF001
                continue
            if awaits_calls(node):
                found.append(self._finding(node, now))
        return found

    def _search(self, executor: object) -> None:
        """Find who has left an executor before it was looked at: those that are in none."""
        kind = class_of("rclpy.node", "Node")
        for node in gc.get_objects():
            if isinstance(node, kind) and awaits_calls(node) and node.executor is not None:
                self._of.setdefault(node, weakref.ref(executor))

    def _finding(self, node: Any, now: object) -> Finding:  # noqa: ANN401
        # An executor that spins makes this anew.
        spun = getattr(now, "_cb_iter", None)
        name, place = str(node.get_name()), self._place(node)
        return Finding((FORSAKEN, id(node)), name, place, FORSAKEN, DEADLOCK_S, spun)

    def _place(self, node: object) -> tuple[str, int]:
        """Return where the learner's own program spins within a callback, else the first line."""
        main = vars(sys.modules["__main__"])
        kinds = [*type(node).__mro__, *(each for each in main.values() if isinstance(each, type))]
        functions = [*(one for kind in kinds for one in vars(kind).values()), *main.values()]
        for function in functions:
            code = getattr(function, "__code__", None)
            if code is None or code.co_filename.rpartition("/")[0] != self._folder:
                continue
            for _start, _end, line in code.co_lines():
                text = linecache.getline(code.co_filename, line or 0)
                if any(word in text for word in _SPINS):
                    return code.co_filename, line or 0
        return str(main.get("__file__", "")), 1


def _endless(look: Look) -> Iterable[Any]:
    """Yield the executors that somebody spins until the end."""
    for thread in look.threads:
        for frame in thread.frames:
            if frame.f_code.co_name != "spin" or not is_of(frame, EXECUTORS, RCLPY):
                continue
            name = "self" if is_of(frame, EXECUTORS) else "executor"
            executor = frame.f_locals.get(name)
            if executor is not None:
                yield executor


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


LONG_S = 0.7
LOOK_S = 0.2
_IN_ENGLISH = "callback {name} still runs after {seconds:g} s{within}: {file}, line {line}"
_IN_RUSSIAN = "обработчик {name} не закончил и через {seconds:g} с{within}: {file}, строка {line}"
"""Both together are less than a second: a callback that sleeps one is noticed."""


def watch(folder: str, *, tells: bool = True) -> None:
    """Report long callbacks that are defined in this folder, each once, from now on.

    `tells`: tell the supervisor of those that are stuck, and when they go on.
    """
    threading.Thread(target=_look, args=(folder, tells), daemon=True, name="deck").start()


def _look(folder: str, tells: bool) -> None:
    known: dict[object, Finding] = {}
    told: set[CodeType] = set()
    homes = Homes(folder)
    before = time.monotonic()
    while True:
        time.sleep(LOOK_S)
        now = time.monotonic()
        passed_s = min(now - before, 2 * LOOK_S)
        before = now
        # A frame that is kept is not used for another call: the same one is the same call.
        found = _findings(folder, homes)
        if found is None:
            continue
        running = {finding.key: finding for finding in found}
        for key, finding in running.items():
            finding.follow(known.get(key), passed_s)
            if finding.long is not None and finding.ran_s >= LONG_S and finding.long not in told:
                told.add(finding.long)
                _report(finding)
            if tells and finding.has_lasted():
                _tell(finding)
        for key, finding in known.items():
            if finding.stuck and not (key in running and running[key].stuck):
                _tell(finding, over=True)
        known = running
        del running, found


def _findings(folder: str, homes: Homes) -> list[Finding] | None:
    """Return what is found; None if something has changed while it was looked at."""
    stacks = sys._current_frames()  # noqa: SLF001 - meant for this
    stacks.pop(threading.get_ident(), None)
    threads = [Thread(number, stack, folder) for number, stack in stacks.items()]
    try:
        look = Look(threads, folder)
        found = look.findings() + homes.findings(look)
    except Exception:  # noqa: BLE001 - the program runs on meanwhile
        return None
    main = next((each for each in threads if each.number == threading.main_thread().ident), None)
    if main is not None and not any(thread.spins for thread in threads):
        asks = {each.key[1] for each in found if isinstance(each.key, tuple) and not each.offered}
        found += unspun(main) if not asks.intersection(main.frames) else []
    return found


def _report(finding: Finding) -> None:
    # Without the catalogues, which it does not load; `launcher.faults.crash` reads both.
    russian = os.environ.get("DECK_LANG", "").startswith("ru")
    words = _IN_RUSSIAN if russian else _IN_ENGLISH
    within = f" {'в' if russian else 'in'} {finding.reported_in}" if finding.reported_in else ""
    words = words.format(name=finding.name, seconds=LONG_S, within=within, file=finding.file, line=finding.line)
    sys.stderr.write(f"[WARN] [{time.time():.9f}] [deck]: {words}\n")
    sys.stderr.flush()


def _tell(finding: Finding, *, over: bool = False) -> None:
    """Tell the supervisor, as `launcher.faults.telling` reads it."""
    seen = {
        "name": finding.name,
        "file": finding.file,
        "line": finding.line,
        "waits_in": finding.waits_in,
        "awaited": finding.awaited,
        "since_s": time.time() - finding.ran_s,
        "over": over,
    }
    sys.stderr.flush()
    os.write(2, b"\x1b]deck;" + json.dumps({"callback": seen}).encode() + b"\x07\n")
