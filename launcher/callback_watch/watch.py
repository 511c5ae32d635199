"""Looking at the threads of a learner's program, and telling what is found."""

from __future__ import annotations

import json
import os
import sys
import threading
import time

from .callbacks import Look
from .nodes import Homes, unspun
from .stacks import Thread

TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import CodeType

    from .finding import Finding

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
