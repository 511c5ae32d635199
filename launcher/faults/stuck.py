"""A callback that does not return, in words: since when, in which line, and what to write."""

from __future__ import annotations

import linecache
import time
from typing import TYPE_CHECKING, Any

from launcher.faults.telling import CALLBACK
from launcher.status import STUCK, NodeFault
from text.i18n import N_
from text.plain import plain
from text.sentences import say

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
    "": N_("Until a callback returns, the node hears nothing: let a timer do the waiting."),
}
"""By what a callback waits in, as `launcher.callback_watch` names it."""


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
    words = say("{name} has been stuck since {time}", name=name, time=since)
    meaning = say(MENDS.get(waits_in, MENDS[""]))
    fault = NodeFault(STUCK, file, line, 0, plain(source), words, meaning)
    return fault, seen.get("over") is True
