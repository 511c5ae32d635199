"""Sorts steps, in whatever order they arrive, into the chains that they belong to."""

from __future__ import annotations

import math
from bisect import insort
from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING

from tui.flow.chains import EARLY_S, Chain

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from tui.flow.chains import FlowStep

MOST_CHAINS = 50
MOST_LOOSE = 400
"""Steps without a chain yet: a log line may arrive before the message that caused it."""


class FlowBook:
    """Chains of steps that follow one cause, made from messages and log lines in whatever order they come."""

    def __init__(self) -> None:
        self._chains: list[Chain] = []
        self._loose: deque[FlowStep] = deque(maxlen=MOST_LOOSE)

    @property
    def chains(self) -> Sequence[Chain]:
        return self._chains

    def clear(self) -> None:
        self._chains.clear()
        self._loose.clear()

    def add(self, steps: Iterable[FlowStep]) -> bool:
        """Add steps; return whether any chain has changed."""
        changed = False
        for step in sorted(steps):
            changed = self._place(step) or changed
        return changed

    def _place(self, step: FlowStep) -> bool:
        chain = self._at(step.time_s)
        if chain is not None and chain.takes(step):
            chain.add(step)
            return True
        if step.begins:
            self._begin(step)
            return True
        self._loose.append(step)
        return False

    def _at(self, time_s: float) -> Chain | None:
        begun = (one for one in reversed(self._chains) if one.start_s <= time_s + EARLY_S)
        return next(begun, None)

    def _begin(self, first: FlowStep) -> None:
        # Chains are identified by their start times.
        while any(chain.start_s == first.time_s for chain in self._chains):
            first = replace(first, time_s=math.nextafter(first.time_s, math.inf))
        chain = Chain(first)
        insort(self._chains, chain, key=lambda one: one.start_s)
        del self._chains[:-MOST_CHAINS]
        waiting = sorted(self._loose)
        self._loose.clear()
        for step in waiting:
            if self._at(step.time_s) is chain and chain.takes(step):
                chain.add(step)
            else:
                self._loose.append(step)
