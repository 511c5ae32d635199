"""A plotted field of a topic: its name, its number in a message, its curve in a plot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, SupportsFloat

from text.plain import plain

if TYPE_CHECKING:
    from graph.data import Sample, Value
    from tui.topics.plot.history import History

LONGEST = 200


class PlotField(NamedTuple):
    """One number in the messages of a topic."""

    topic: str
    path: tuple[str | int, ...]
    """Field names and indexes: `("ranges", 3)`."""

    @property
    def name(self) -> str:
        """The path as written by users: `drive.speed`, `ranges[3]`."""
        parts = [f"[{step}]" if isinstance(step, int) else f".{step}" for step in self.path]
        return plain("".join(parts).removeprefix("."), LONGEST)

    def number(self, message: Mapping[str, Value]) -> float | None:
        """The field's number, including nan and infinities; None if there is none."""
        value: object = message
        for step in self.path:
            if isinstance(value, Mapping):
                if step not in value:
                    return None
                value = value[step]
            elif isinstance(step, int) and _is_indexed(value):
                if not 0 <= step < len(value):  # type: ignore[arg-type]
                    return None
                value = value[step]  # type: ignore[index]
            else:
                return None
        return as_number(value)


@dataclass
class Series:
    """One field with its letter in the plot, its look and its history."""

    field: PlotField
    letter: str
    look: str
    history: History
    is_number: bool = True
    """Whether the newest message had a number in this field."""

    def take(self, sample: Sample) -> None:
        """Add the number from one message."""
        number = self.field.number(sample.value)
        self.is_number = number is not None
        self.history.add(sample.received_s - sample.age_s, number)


def as_number(value: object) -> float | None:
    """A number or a boolean as a float; None for anything else."""
    if not isinstance(value, SupportsFloat) or hasattr(value, "__len__"):
        return None
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _is_indexed(value: object) -> bool:
    """Whether it is an array, of numbers (numpy) or of anything else except characters."""
    return hasattr(value, "__len__") and not isinstance(value, (str, bytes))
