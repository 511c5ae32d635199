"""The order in which nodes start and stop."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence


def with_needs(names: Iterable[str], needs: Mapping[str, Sequence[str]]) -> list[str]:
    """Return `names` and everything they need, directly or not, in starting order."""
    ordered: list[str] = []

    def visit(name: str) -> None:
        if name not in ordered:
            for needed in needs.get(name, ()):
                visit(needed)
            ordered.append(name)

    for name in names:
        visit(name)
    return ordered


def stop_waves(names: Iterable[str], needs: Mapping[str, Sequence[str]]) -> list[list[str]]:
    """Group `names` so that none is stopped before the others that need it."""
    left = list(names)
    waves = []
    while left:
        still_needed = {other for name in left for other in _all_needs(name, needs)}
        wave = [name for name in left if name not in still_needed]
        waves.append(wave)
        left = [name for name in left if name in still_needed]
    return waves


def _all_needs(name: str, needs: Mapping[str, Sequence[str]]) -> set[str]:
    return set(with_needs([name], needs)) - {name}
