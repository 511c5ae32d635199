"""Asks before a goal is cancelled that somebody else has sent."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _
from text.plain import plain
from tui.actions import Action, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.binding import BindingType

    from graph.data import SeenGoal

LONGEST = 300


class CancelIt(Action["CancelGoalScreen"]):
    """Ask its server to."""

    id = "cancel_goal.cancel"
    key = "enter"
    title = N_("Cancel the goal")
    tooltip = N_("Ask its server to cancel it; whoever sent it is told by the server.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: CancelGoalScreen) -> None:
        """Answer yes."""
        target.dismiss(target.goal)


class LeaveIt(Action["CancelGoalScreen"]):
    """Let it go on."""

    id = "cancel_goal.leave"
    key = "escape"
    title = N_("Leave it")
    tooltip = N_("Back to the goals as they are.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: CancelGoalScreen) -> None:
        """Answer no."""
        target.dismiss(None)


class CancelGoalScreen(Dialog["SeenGoal | None"]):
    """Answers with the goal if it is to be cancelled."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(CancelIt, LeaveIt)

    def __init__(self, goal: SeenGoal, state: str) -> None:
        """Ask about `goal`, of which the list says `state`."""
        super().__init__()
        self.goal = goal
        self._state = state

    def title_words(self) -> str:
        """Name the question."""
        return _("Cancel a goal of another client?")

    def words(self) -> Content:
        """Say which, and what it does."""
        lines = [
            Content.styled(plain(self.goal.action, LONGEST), "bold"),
            Content(f"{self.goal.goal_id}  {self._state}"),
            Content(""),
            Content(_("Another program has sent it and waits for its end.")),
        ]
        return Content("\n").join(lines)
