"""What an answer of a language model took, in words: tokens, times, cost, and the budget.

The figures come from the Composer's own questions, or from the nodes by /brain_state.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from text.figures import figure, whole
from text.i18n import _
from text.plain import plain
from text.sentences import Words, say

if TYPE_CHECKING:
    from brain.budget import TokenUsage, Totals
    from brain.settings import BudgetSettings, PriceSettings
    from graph.data import Sample

COMPOSER = "composer"
"""Who asks from the screen: in the log, and in the ledger of the budget."""
LONGEST_NAME = 60
ONE_CENT = 0.01
"""A lower cost is written with its first two digits, wherever they are."""
MOST_DECIMALS = 9


@dataclass(frozen=True)
class UsageFigures:
    """What one answer took."""

    model: str
    input_tokens: int
    output_tokens: int
    first_token_s: float
    total_s: float
    cost: float | None = None
    """None without prices."""
    currency: str = ""
    counted: bool = True
    """Whether the server counted the tokens."""


@dataclass(frozen=True)
class BudgetFigures:
    """What was taken of the budget that all of a session's nodes and screens share."""

    calls_last_minute: int
    calls_per_minute: int
    tokens: int
    tokens_per_session: int


@dataclass(frozen=True)
class BrainReport:
    """What a node that asks a model says of itself on /brain_state."""

    node: str
    level: int
    """0 OK, 1 warning, 2 error."""
    message: str
    backend: str
    """`rules` or `llm`."""
    fault: str
    """`brain.faults.FaultKind`; empty if there is none."""
    model: str
    budget: BudgetFigures | None
    usage: UsageFigures | None


def usage_of(usage: TokenUsage, prices: PriceSettings | None) -> UsageFigures:
    """Return the figures of an answer."""
    return UsageFigures(
        usage.model,
        usage.input_tokens,
        usage.output_tokens,
        usage.first_token_s,
        usage.total_s,
        usage.cost(prices),
        "" if prices is None else prices.currency,
        usage.counted,
    )


def budget_of(totals: Totals, budget: BudgetSettings) -> BudgetFigures:
    """Return how far the budget is used up."""
    return BudgetFigures(totals.calls_last_minute, budget.calls_per_minute, totals.tokens, budget.tokens_per_session)


def usage_words(usage: UsageFigures, *, named: bool = True) -> str:
    """`m-1: 120 + 40 tokens · first 0.31 s · all 1.20 s · 0.0021 USD`."""
    about = "" if usage.counted else "≈"
    parts = [
        _("{tokens_in} + {tokens_out} tokens").format(
            tokens_in=f"{about}{whole(usage.input_tokens)}", tokens_out=whole(usage.output_tokens)
        ),
        _("first {seconds} s").format(seconds=figure(usage.first_token_s)),
        _("all {seconds} s").format(seconds=figure(usage.total_s)),
    ]
    if cost := cost_words(usage):
        parts.append(cost)
    words = " · ".join(parts)
    return f"{plain(usage.model, LONGEST_NAME)}: {words}" if named and usage.model else words


def noted(usage: UsageFigures) -> Words:
    """Return the same as a line of the log, which is translated when it is shown."""
    values: dict[str, object] = {
        "model": usage.model,
        "tokens_in": usage.input_tokens,
        "tokens_out": usage.output_tokens,
        "first": usage.first_token_s,
        "total": usage.total_s,
    }
    if usage.cost is None:
        return say(
            "{model}: {tokens_in} + {tokens_out} tokens, the first after {first:.2f} s, all {total:.2f} s", **values
        )
    return say(
        "{model}: {tokens_in} + {tokens_out} tokens, the first after {first:.2f} s, "
        "all {total:.2f} s, {cost:.5f} {currency}",
        **values,
        cost=usage.cost,
        currency=usage.currency,
    )


def usage_noted(line: str) -> UsageFigures | None:
    """Return what a line of the log says that `noted` has made, None for another one."""
    if not isinstance(line, Words) or "tokens_in" not in line.values:
        return None
    values: Mapping[str, Any] = line.values
    return UsageFigures(
        values["model"],
        values["tokens_in"],
        values["tokens_out"],
        values["first"],
        values["total"],
        values.get("cost"),
        values.get("currency", ""),
    )


def cost_words(usage: UsageFigures) -> str:
    """`0.0021 USD`; empty without prices."""
    if usage.cost is None:
        return ""
    return f"{_amount(usage.cost)} {plain(usage.currency, 8)}".rstrip()


def _amount(cost: float) -> str:
    """`1.25`, and `0.000042` with its first two digits."""
    if not 0 < cost < ONE_CENT:
        return figure(cost, 2)
    return figure(cost, min(MOST_DECIMALS, 1 - math.floor(math.log10(cost))))


def budget_words(budget: BudgetFigures) -> str:
    """`3 of 20 calls a minute · 460 of 200000 tokens`."""
    calls = _("{count} of {limit} calls a minute").format(
        count=budget.calls_last_minute, limit=whole(budget.calls_per_minute)
    )
    tokens = _("{count} of {limit} tokens").format(count=whole(budget.tokens), limit=whole(budget.tokens_per_session))
    return f"{calls} · {tokens}"


def brain_reports(sample: Sample) -> list[BrainReport]:
    """Read a diagnostic_msgs/DiagnosticArray; accepts any message."""
    statuses: Any = sample.value.get("status", ())
    listed = statuses if isinstance(statuses, (list, tuple)) else ()
    return [_report(status) for status in listed if isinstance(status, Mapping)]


def _report(status: Mapping[str, Any]) -> BrainReport:
    pairs: Any = status.get("values", ())
    values: dict[str, str] = {}
    for pair in pairs if isinstance(pairs, (list, tuple)) else ():
        if isinstance(pair, Mapping):
            values[str(pair.get("key", ""))] = str(pair.get("value", ""))
    level = status.get("level", 0)
    if isinstance(level, (bytes, bytearray)):
        level = level[0] if level else 0
    return BrainReport(
        plain(str(status.get("name", "")), LONGEST_NAME),
        level if isinstance(level, int) else 0,
        plain(str(status.get("message", "")), 300),
        values.get("backend", ""),
        values.get("fault", ""),
        plain(values.get("model", ""), LONGEST_NAME),
        _budget(values),
        _usage(values),
    )


def _budget(values: Mapping[str, str]) -> BudgetFigures | None:
    try:
        return BudgetFigures(
            int(values["calls_last_minute"]),
            int(values["calls_per_minute"]),
            int(values["tokens"]),
            int(values["tokens_per_session"]),
        )
    except (KeyError, ValueError):
        return None


def _usage(values: Mapping[str, str]) -> UsageFigures | None:
    try:
        cost = values.get("cost", "")
        return UsageFigures(
            values.get("model", ""),
            int(values["input_tokens"]),
            int(values["output_tokens"]),
            float(values["first_token_s"]),
            float(values["total_s"]),
            float(cost) if cost else None,
            values.get("currency", ""),
        )
    except (KeyError, ValueError):
        return None
