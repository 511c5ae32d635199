"""Drawing the values of a run from a seed: the same seed gives the same values."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launcher.profile.steps.expressions import Drawn
    from launcher.profile.steps.model import ValueDocument

LARGEST_SEED = 99_999


def new_seed() -> int:
    """Return a seed that is short enough to be typed."""
    return random.SystemRandom().randint(1, LARGEST_SEED)


def draw(values: Mapping[str, ValueDocument], seed: int) -> dict[str, Drawn]:
    """Return a value for each name; one value more or less does not change the others."""
    return {name: _drawn(value, random.Random(f"{seed}/{name}")) for name, value in values.items()}


def _drawn(value: ValueDocument, source: random.Random) -> Drawn:
    if value.between is None:
        chosen: Drawn = source.choice(value.one_of)
        return chosen
    low, high = value.between
    if value.digits is None and low == int(low) and high == int(high):
        return source.randint(int(low), int(high))
    return round(source.uniform(low, high), 2 if value.digits is None else value.digits)
