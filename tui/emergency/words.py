"""The text of the banner of the emergency stop: who engaged it, when, and where nodes differ."""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING

from text.i18n import _
from text.plain import plain
from tui.emergency.nodes import DECKS, PICO

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tui.emergency.state import Emergency


def stop_words(state: Emergency, release_key: str) -> tuple[str, ...]:
    """Return the texts to show while it is engaged, from long to short."""
    release = _("{key} starts them again") if state.ended else _("{key} releases")
    release = release.format(key=release_key)
    head, since, differing = _head(state), _since(state), differing_words(state)
    why = _(state.fallback) if state.fallback else ""
    lines: tuple[tuple[str, ...], ...] = (
        (head + since, differing, why, release),
        (head, differing, why, release),
        (head, differing, release),
        (head, release),
        (_("■ EMERGENCY STOP"), release),
    )
    if state.waits:
        lines = (*lines[:3], (_("■ EMERGENCY STOP"), _("waits for a node")))
    elif state.unconfirmed:
        # Whether it holds matters more than the key that ends it.
        lines = (*lines[:3], (_("■ EMERGENCY STOP"), _("unconfirmed")))
    return tuple(dict.fromkeys(" · ".join(filter(None, parts)) for parts in lines))


def shown_of(state: Emergency) -> tuple[object, ...]:
    """Return all that is shown on the screen, since nodes repeat their reports all the time."""
    words = stop_words(state, "") if state.engaged else ()
    return state.engaged, words, state.blocked, state.gate


def differing_words(state: Emergency) -> str:
    """Say which nodes deviate from the others, or from what was asked; empty if none does."""
    held, free = state.holders, state.free
    contradicted = [state.nodes[name] for name in held if state.nodes[name].contradicted]
    if contradicted:
        others = {name for node in contradicted for name in node.publishers if not _is_own(name)}
        words = _("not released: others keep stopping ({nodes})")
        return words.format(nodes=_names(others) or "?")
    if state.overdue:
        return _("released here, still held by {nodes}").format(nodes=_names(state.overdue))
    if held and free:
        words = _("held by {held}, released by {free}")
        return words.format(held=_names(held), free=_names(free))
    if free and state.asked:
        return _("not obeyed by {nodes}").format(nodes=_names(free))
    return _unconfirmed_words(state)


def _unconfirmed_words(state: Emergency) -> str:
    if state.waits:
        return _("waits for the first node that can obey")
    if state.unconfirmed:
        return _("pressed, nobody has confirmed it")
    if state.silent:
        return _("not confirmed by {nodes}").format(nodes=_names(state.silent))
    return ""


def _head(state: Emergency) -> str:
    """Say who engaged it, as far as that is known."""
    if state.ours:
        return _("■ EMERGENCY STOP")
    held = [state.nodes[name] for name in state.holders]
    if held and all(node.by == PICO for node in held):
        return _("■ EMERGENCY STOP (kept by the Pico)")
    if held and all(node.before for node in held):
        return _("■ EMERGENCY STOP (from earlier)")
    said_by = {name for node in held for name in node.publishers if not _is_own(name)}
    if len(said_by) == 1 and not min(said_by).startswith(DECKS):
        return _("■ EMERGENCY STOP (by {node})").format(node=_names(said_by))
    return _("■ EMERGENCY STOP (by another)")


def _is_own(node: str) -> bool:
    """Return whether it is this screen's own node, which did not send the stop."""
    return node.startswith(DECKS) and node.endswith(f"_{os.getpid()}")


def _since(state: Emergency) -> str:
    times = [state.nodes[name].since_s for name in state.holders]
    if not times or min(times) <= 0.0:
        return ""
    try:
        since = time.localtime(min(times))
    except (OverflowError, OSError, ValueError):
        return ""
    today = time.localtime()[:3] == since[:3]
    return " " + _("since {time}").format(time=time.strftime("%H:%M:%S" if today else "%Y-%m-%d %H:%M", since))


def _names(names: Iterable[str]) -> str:
    return plain(", ".join(name.strip("/") for name in sorted(names)), 120)
