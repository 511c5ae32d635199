"""What was asked and what it took, kept below the user's limits by all processes of a session.

The ledger is a file of JSON lines in the run's folder, one line for each call begun and one for
each ended, written under a lock; without a folder it is kept in memory.
"""

from __future__ import annotations

import fcntl
import json
import os
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, TextIO

from brain.faults import FaultKind, ModelError
from text.nested import read_json
from text.os_words import os_reason
from text.run_path import MODEL_USAGE
from text.sentences import say

if TYPE_CHECKING:
    from pathlib import Path

    from brain.settings import BudgetSettings, PriceSettings

MINUTE_S = 60.0
CHARS_PER_TOKEN = 4
"""For servers that do not count: the usual rule for English."""
_FLAGS = os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC


@dataclass(frozen=True)
class TokenUsage:
    """What one answer took."""

    model: str
    input_tokens: int
    output_tokens: int
    first_token_s: float
    """From the request to the first piece of the answer."""
    total_s: float
    counted: bool = True
    """Whether the server counted the tokens; otherwise they are estimated from the characters."""

    def cost(self, prices: PriceSettings | None) -> float | None:
        """Return the price in the settings' currency, None without prices."""
        if prices is None:
            return None
        million = 1e6
        return (
            self.input_tokens * prices.input_per_million + self.output_tokens * prices.output_per_million
        ) / million


@dataclass(frozen=True)
class Totals:
    """What a session has taken so far."""

    calls: int = 0
    calls_last_minute: int = 0
    tokens: int = 0
    oldest_age_s: float = 0.0
    """Age of the oldest call of the last minute."""


def summed(usages: Sequence[TokenUsage]) -> TokenUsage:
    """Return what several answers of one model took together; the first token is that of the first.

    There is at least one.
    """
    return TokenUsage(
        usages[0].model,
        sum(usage.input_tokens for usage in usages),
        sum(usage.output_tokens for usage in usages),
        usages[0].first_token_s,
        sum(usage.total_s for usage in usages),
        all(usage.counted for usage in usages),
    )


def estimated_tokens(text: str) -> int:
    """Return about how many tokens a text has."""
    return (len(text) + CHARS_PER_TOKEN - 1) // CHARS_PER_TOKEN


class Ledger:
    """The calls of a session; several processes may share its file."""

    def __init__(self, folder: Path | None = None) -> None:
        """Keep the ledger in this folder; None for one in memory."""
        self._path = None if folder is None else folder / MODEL_USAGE
        self._lines: list[dict[str, Any]] = []

    def begin(self, who: str, budget: BudgetSettings) -> None:
        """Note that a call begins.

        Raises:
            ModelError: if the budget does not allow it; then nothing is noted.
        """
        with self._locked() as lines:
            totals = _totals(lines)
            if totals.calls_last_minute >= budget.calls_per_minute:
                wait_s = max(0.0, MINUTE_S - totals.oldest_age_s)
                words = say(
                    "the budget of {count} calls a minute is used up: next one in {wait:.0f} s",
                    count=budget.calls_per_minute,
                    wait=wait_s,
                )
                fix = say("calls_per_minute in llm.yaml")
                raise ModelError(FaultKind.BUDGET, words, fix, retry_after_s=wait_s)
            if totals.tokens >= budget.tokens_per_session:
                words = say("the budget of {count} tokens a session is used up", count=budget.tokens_per_session)
                raise ModelError(FaultKind.BUDGET, words, say("tokens_per_session in llm.yaml"))
            lines.append({"begun_s": time.time(), "who": who})

    def end(self, who: str, usage: TokenUsage) -> None:
        """Note what a call took."""
        line = {"ended_s": time.time(), "who": who, **asdict(usage)}
        if self._path is None:
            self._lines.append(line)
            return
        with self._opened(self._path) as file:
            file.write(json.dumps(line) + "\n")

    def totals(self) -> Totals:
        """Return what was taken so far."""
        with self._locked() as lines:
            return _totals(lines)

    @contextmanager
    def _locked(self) -> Iterator[list[dict[str, Any]]]:
        """Give the lines; what is appended to them is kept."""
        if self._path is None:
            yield self._lines
            return
        with self._opened(self._path) as file:
            lines = [line for text in file if (line := _parsed(text)) is not None]
            before = len(lines)
            yield lines
            file.writelines(json.dumps(line) + "\n" for line in lines[before:])

    @staticmethod
    @contextmanager
    def _opened(path: Path) -> Iterator[TextIO]:
        """Open the file for this process alone; what is written goes to its end."""
        try:
            descriptor = os.open(path, _FLAGS, 0o600)
        except OSError as error:
            reason = os_reason(error)
            words = say("{path}: cannot be written: {reason}", path=str(path), reason=reason)
            raise ModelError(FaultKind.BUDGET, words) from None
        with os.fdopen(descriptor, "r+", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            yield file
            file.flush()


def _parsed(text: str) -> dict[str, Any] | None:
    """Return a line of the ledger; None for one that a killed process left incomplete."""
    try:
        line = read_json(text)
    except ValueError:
        return None
    return line if isinstance(line, dict) else None


def _totals(lines: list[dict[str, Any]]) -> Totals:
    now_s = time.time()
    begun = [float(line["begun_s"]) for line in lines if "begun_s" in line]
    # A clock that is set back must not lock the user out: what lies in the future has passed.
    recent = [at_s for at_s in begun if 0 <= now_s - at_s < MINUTE_S]
    tokens = sum(int(line["input_tokens"]) + int(line["output_tokens"]) for line in lines if "ended_s" in line)
    return Totals(len(begun), len(recent), tokens, now_s - min(recent, default=now_s))
