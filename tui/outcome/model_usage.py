"""What an answer of a language model took, in words: tokens, times, cost, and the budget.

The figures come from the Composer's own questions, or from the nodes by /brain_state.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from graph.diagnostics import statuses
from text.figures import figure, whole
from text.i18n import _
from text.plain import plain
from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Mapping

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
    tokens_in: int
    tokens_out: int
    first: float
    """Seconds until it began."""
    total: float
    """Seconds until it was whole."""
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
    model: str
    budget: BudgetFigures | None
    usage: UsageFigures | None


def usage_of(usage: TokenUsage, prices: PriceSettings | None) -> UsageFigures:
    """Return the figures of an answer."""
    took = (usage.input_tokens, usage.output_tokens, usage.first_token_s, usage.total_s)
    currency = "" if prices is None else prices.currency
    return UsageFigures(usage.model, *took, usage.cost(prices), currency, usage.counted)


def budget_of(totals: Totals, budget: BudgetSettings) -> BudgetFigures:
    """Return how far the budget is used up."""
    return BudgetFigures(totals.calls_last_minute, budget.calls_per_minute, totals.tokens, budget.tokens_per_session)


def usage_words(usage: UsageFigures, *, named: bool = True) -> str:
    """`m-1: 120 + 40 tokens · first 0.31 s · all 1.20 s · 0.0021 USD`."""
    about = "" if usage.counted else "≈"
    parts = [
        _("{tokens_in} + {tokens_out} tokens").format(
            tokens_in=f"{about}{whole(usage.tokens_in)}", tokens_out=whole(usage.tokens_out)
        ),
        _("first {seconds} s").format(seconds=figure(usage.first)),
        _("all {seconds} s").format(seconds=figure(usage.total)),
    ]
    if usage.cost is not None:
        parts.append(f"{_amount(usage.cost)} {plain(usage.currency, 8)}".rstrip())
    words = " · ".join(parts)
    return f"{plain(usage.model, LONGEST_NAME)}: {words}" if named and usage.model else words


def _amount(cost: float) -> str:
    """`1.25`, and `0.000042` with its first two digits."""
    if not 0 < cost < ONE_CENT:
        return figure(cost, 2)
    return figure(cost, min(MOST_DECIMALS, 1 - math.floor(math.log10(cost))))


NOTED = ("model", "tokens_in", "tokens_out", "first", "total", "cost", "currency")


def noted(usage: UsageFigures) -> Words:
    """Return the same as a line of the log, which is translated when it is shown."""
    values: dict[str, object] = {name: getattr(usage, name) for name in NOTED}
    if usage.cost is None:
        return say(
            "{model}: {tokens_in} + {tokens_out} tokens, the first after {first:.2f} s, all {total:.2f} s", **values
        )
    return say(
        "{model}: {tokens_in} + {tokens_out} tokens, the first after {first:.2f} s, "
        "all {total:.2f} s, {cost:.5f} {currency}",
        **values,
    )


def usage_noted(line: str) -> UsageFigures | None:
    """Return what a line of the log says that `noted` has made, None for another one."""
    if not isinstance(line, Words) or "tokens_in" not in line.values:
        return None
    values: Mapping[str, Any] = line.values
    return UsageFigures(**{name: values[name] for name in NOTED if name in values})


def budget_words(budget: BudgetFigures) -> str:
    """`3 of 20 calls a minute · 460 of 200000 tokens`."""
    calls = _("{count} of {limit} calls a minute").format(
        count=budget.calls_last_minute, limit=whole(budget.calls_per_minute)
    )
    tokens = _("{count} of {limit} tokens").format(count=whole(budget.tokens), limit=whole(budget.tokens_per_session))
    return f"{calls} · {tokens}"


def brain_reports(sample: Sample) -> list[BrainReport]:
    """Read a diagnostic_msgs/DiagnosticArray; accepts any message."""
    return [
        BrainReport(
            *(one.name, int(one.level), one.message, plain(one.values.get("model", ""), LONGEST_NAME)),
            *(_budget(one.values), _usage(one.values)),
        )
        for one in statuses(sample)
    ]


def _budget(values: Mapping[str, str]) -> BudgetFigures | None:
    try:
        calls = int(values["calls_last_minute"]), int(values["calls_per_minute"])
        return BudgetFigures(*calls, int(values["tokens"]), int(values["tokens_per_session"]))
    except (KeyError, ValueError):
        return None


def _usage(values: Mapping[str, str]) -> UsageFigures | None:
    try:
        tokens = int(values["input_tokens"]), int(values["output_tokens"])
        seconds = float(values["first_token_s"]), float(values["total_s"])
        cost = float(values["cost"]) if values.get("cost") else None
    except (KeyError, ValueError):
        return None
    return UsageFigures(values.get("model", ""), *tokens, *seconds, cost, values.get("currency", ""))
