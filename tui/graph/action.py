"""An action: its goal form, its goals, those of Deck and those of others, and cancelling them."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from typing import Any, ClassVar

from textual.binding import BindingType
from textual.content import Content

from graph.data import Goal, GoalStatus, SeenGoal
from graph.observer.requests import CancelGoal, CancelSeenGoal, ForgetGoal, SendGoal
from text import ros2_words
from text.figures import figure
from text.i18n import N_, _, localized
from text.plain import plain
from text.sentences import reason_of
from tui.dialogs.dialog import Dialog, answers
from tui.graph.ask import Answer, AskPane
from tui.graph.pane import LONGEST
from tui.widgets.rows import Cell, Column, Row
from tui.yaml_form.form import submit_form

STATES = {
    GoalStatus.SENDING: ("◌", N_("sending"), "dim"),
    GoalStatus.REJECTED: ("✗", N_("rejected"), "bad"),
    GoalStatus.ACCEPTED: ("◔", N_("accepted"), "warn"),
    GoalStatus.EXECUTING: ("●", N_("executing"), "good"),
    GoalStatus.CANCELING: ("◑", N_("canceling"), "warn"),
    GoalStatus.SUCCEEDED: ("✓", N_("succeeded"), "good"),
    GoalStatus.CANCELED: ("○", N_("canceled"), "dim"),
    GoalStatus.ABORTED: ("✗", N_("aborted"), "bad"),
    GoalStatus.FAILED: ("✗", N_("lost"), "bad"),
}
"""Maps a status to sign, word and meaning: colour is never the only indication."""
SHORT_ID = 8
"""Number of digits of an id that are shown; two goals of one action hardly ever share them."""


class ActionPane(AskPane):
    """Sends goals; feedback and result arrive with the updates of the graph."""

    submit_title = N_("Send goal")
    calls_it = N_("sends it goals")
    _sent_newest: int | None = None
    """To be chosen once an update of the graph contains it."""

    @property
    def goals(self) -> list[Goal | SeenGoal]:
        """The goals of the action that is shown: Deck's own, then those that others have sent; the newest first."""
        update = self.graph_now
        if update is None:
            return []
        goals: tuple[Goal | SeenGoal, ...] = (*reversed(update.goals), *reversed(update.seen_goals))
        return [goal for goal in goals if goal.action == self.name_shown]

    @property
    def chosen(self) -> Goal | SeenGoal | None:
        wanted = self.asked_rows.chosen
        return next((goal for goal in self.goals if _key(goal) == wanted), None)

    def ends(self) -> tuple[Sequence[str], Sequence[str], Sequence[str]] | None:
        update = self.graph_now
        rows = () if update is None else update.actions
        found = ((row.type_names, row.servers, row.clients) for row in rows if row.name == self.name_shown)
        return next(found, None)

    def asked(self) -> tuple[Sequence[Column], Sequence[Row]]:
        return (Column("", 8), Column("", 13), Column("", 8), Column("")), [_row(goal) for goal in self.goals]

    def answer(self) -> Answer:
        goal = self.chosen
        if goal is None:
            way_out = _("{key} sends what is filled in.").format(key=self.deck.keys_of(submit_form)[0])
            return _("Feedback and result"), self.name_shown, (_("no goal has been sent yet"), way_out)
        name = f"{self.name_shown} {_key(goal)}"
        state = f"{_name(goal)} {_words(goal)}"
        if isinstance(goal, SeenGoal):
            state = f"{state} · " + _("of another client")
        if goal.error:
            return state, name, (_(STATES[goal.status][1]), plain(localized(goal.error), LONGEST))
        if isinstance(goal, Goal) and goal.result is not None:
            return f"{state} · " + _("result"), f"{name} result", goal.result
        if goal.feedback is not None:
            count = _("feedback {n}").format(n=goal.feedback_count)
            return f"{state} · {count}", name, goal.feedback
        return state, name, (_("no feedback yet"), "")

    def ros2_line(self, type_name: str, value: Mapping[str, Any]) -> str:
        return ros2_words.send_goal(self.name_shown, type_name, value)

    def ros2_info(self) -> str:
        return ros2_words.action_info(self.name_shown)

    def ask(self, type_name: str, value: Mapping[str, Any]) -> None:
        graph = self.deck.feed.graph
        if graph is not None:
            future = graph.ask(SendGoal(self.name_shown, type_name, value))
            self.run_worker(self._sent(future), exit_on_error=False)

    async def _sent(self, future: Future[int]) -> None:
        try:
            self._sent_newest = await asyncio.wrap_future(future)
        except Exception as error:  # noqa: BLE001 - any failure is reported
            self.warn(_("Not sent: {reason}").format(reason=localized(reason_of(error))))
            return
        self.redraw()

    def redraw(self) -> None:
        super().redraw()
        if self._sent_newest in [goal.number for goal in self.goals if isinstance(goal, Goal)]:
            self.asked_rows.choose(str(self._sent_newest))
            self._sent_newest = None

    @property
    def can_cancel(self) -> bool:
        return self._to_cancel is not None

    @property
    def _to_cancel(self) -> Goal | SeenGoal | None:
        """The chosen goal; if that one has ended, the newest active one, preferring Deck's own."""
        return next((goal for goal in (self.chosen, *self.goals) if goal is not None and not goal.ended), None)

    def cancel(self) -> None:
        """Cancel a goal; one of another client only after confirmation."""
        graph, goal = self.deck.feed.graph, self._to_cancel
        if isinstance(goal, SeenGoal):
            seen = CancelSeenGoal(goal.action, goal.goal_id)

            def answered(wanted: bool | None) -> None:
                if wanted and graph is not None:
                    graph.ask(seen)

            self.app.push_screen(CancelGoalScreen(goal), answered)
        elif graph is not None and goal is not None:
            graph.ask(CancelGoal(goal.number))

    @property
    def can_forget(self) -> bool:
        return isinstance(self.chosen, Goal)

    def forget(self) -> None:
        graph, goal = self.deck.feed.graph, self.chosen
        if graph is not None and isinstance(goal, Goal):
            graph.ask(ForgetGoal(goal.number))


def _key(goal: Goal | SeenGoal) -> str:
    return str(goal.number) if isinstance(goal, Goal) else goal.goal_id


def _name(goal: Goal | SeenGoal) -> str:
    """Return the goal's label: Deck's number for it, or the beginning of its id."""
    return f"#{goal.number}" if isinstance(goal, Goal) else goal.goal_id[:SHORT_ID]


def _words(goal: Goal | SeenGoal) -> str:
    sign, word, _meaning = STATES[goal.status]
    return f"{sign} {_(word)}"


def _row(goal: Goal | SeenGoal) -> Row:
    told = _("feedback {n}").format(n=goal.feedback_count)
    if goal.error:
        told = plain(localized(goal.error), LONGEST)
    age_s, whose = (goal.elapsed_s, _("own")) if isinstance(goal, Goal) else (goal.age_s, _("other"))
    age = "" if age_s is None else _("{n} s").format(n=figure(age_s, 1))
    state = Cell(_words(goal), STATES[goal.status][2])
    return Row(_key(goal), (Cell(_name(goal)), state, Cell(age, "dim"), Cell(f"{whose} · {told}", "dim")))


class CancelGoalScreen(Dialog[bool]):
    """Asks whether a goal of another client is to be cancelled."""

    BINDINGS: ClassVar[list[BindingType]] = answers(
        (
            *("cancel_goal.cancel", "enter"),
            *(N_("Cancel the goal"), N_("Ask its server to cancel it; the server informs whoever sent it."), True),
        ),
        ("cancel_goal.leave", "escape", N_("Leave it"), N_("Back to the goals as they are."), False),
    )

    def __init__(self, goal: SeenGoal) -> None:
        super().__init__()
        self._goal, self._state = goal, _words(goal)

    def title_words(self) -> str:
        return _("Cancel a goal of another client?")

    def words(self) -> Content:
        lines = [
            Content.styled(plain(self._goal.action, LONGEST), "bold"),
            Content(f"{self._goal.goal_id}  {self._state}"),
            Content(""),
            Content(_("Another program sent it and is waiting for its result.")),
        ]
        return Content("\n").join(lines)
