"""Goals and publications that have ended with the process that was at them, until forgotten."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from graph.data import GoalStatus

if TYPE_CHECKING:
    from graph.data import Goal, GraphUpdate, Publication


class LostWork:
    """Adds them to each update, with the reason why they ended."""

    def __init__(self) -> None:
        self.next_number = 1
        """Goals and publications of the next process are numbered beyond those of the last."""
        self._goals: dict[int, Goal] = {}
        self._publications: dict[int, Publication] = {}

    def lose(self, update: GraphUpdate, why: str) -> tuple[Goal, ...]:
        """Take over what the last update of a process has; return the goals that were under way."""
        self._goals |= {goal.number: _ended(goal, why) for goal in update.goals}
        self._publications |= {
            one.number: one if one.error else replace(one, error=why) for one in update.publications
        }
        numbers = (*self._goals, *self._publications)
        self.next_number = max((self.next_number, *(number + 1 for number in numbers)))
        return tuple(goal for goal in update.goals if not goal.ended)

    def added_to(self, update: GraphUpdate) -> GraphUpdate:
        if not (self._goals or self._publications):
            return update
        goals = {goal.number: goal for goal in (*update.goals, *self._goals.values())}
        ones = {one.number: one for one in (*update.publications, *self._publications.values())}
        return replace(
            update,
            goals=tuple(goals[number] for number in sorted(goals)),
            publications=tuple(ones[number] for number in sorted(ones)),
        )

    def heed(self, name: str, *arguments: object) -> bool:
        """Heed an order to stop or to forget; return whether one of these is gone by it."""
        before = len(self._goals) + len(self._publications)
        if name == "forget_goal":
            self._goals = {key: one for key, one in self._goals.items() if key not in arguments}
        elif name == "stop_publishing":
            kept = {key: one for key, one in self._publications.items() if key not in arguments}
            self._publications = kept
        elif name in ("stop_publishing_all", "stop_commanding"):
            self._publications.clear()
        return len(self._goals) + len(self._publications) < before


def _ended(goal: Goal, why: str) -> Goal:
    return goal if goal.ended else replace(goal, status=GoalStatus.FAILED, error=why)
