"""An action: its goal form, and the goals that Deck has sent with what comes of them."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, ClassVar

from graph.data import GoalStatus
from text.plain import plain
from tui.figures import figure
from tui.i18n import N_, _, ngettext, said
from tui.widgets.graph_ask import AskPane
from tui.widgets.graph_links import heading, link, node_links
from tui.widgets.graph_pane import LONGEST
from tui.widgets.graph_place import Kind, Place
from tui.widgets.rows import Cell, Column, Row

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from concurrent.futures import Future

    from graph.data import ActionRow, Goal

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
"""Status to sign, word and meaning: never the colour alone."""


class ActionPane(AskPane):
    """Sends goals; feedback and result come with the updates of the graph."""

    submit_title: ClassVar[str] = N_("Send goal")

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._sent_newest: int | None = None
        """To be chosen when an update of the graph has it."""

    @property
    def goals(self) -> Sequence[Goal]:
        """Those of the action that is shown, the newest first."""
        update = self.graph_now
        goals = () if update is None else update.goals
        return [goal for goal in reversed(goals) if goal.action == self.name_shown]

    @property
    def chosen(self) -> Goal | None:
        """The chosen one."""
        wanted = self.asked_rows.chosen
        return next((goal for goal in self.goals if str(goal.number) == wanted), None)

    @property
    def row(self) -> ActionRow | None:
        """The action as it is in the graph now."""
        update = self.graph_now
        actions = () if update is None else update.actions
        return next((row for row in actions if row.name == self.name_shown), None)

    def type_names(self) -> tuple[str, ...]:
        """Return its types."""
        return () if self.row is None else self.row.type_names

    def links(self) -> Sequence[Row]:
        """Return its type, who serves it, and who sends it goals."""
        row = self.row
        if row is None:
            return [heading(_("It has left the graph."))]
        return [
            *(link(Place(Kind.TYPE, name), "type", _("type")) for name in row.type_names),
            *node_links(row.servers, "serves", _("serves it")),
            *node_links(row.clients, "calls", _("sends it goals")),
        ]

    def asked(self) -> tuple[Sequence[Column], Sequence[Row]]:
        """Return the goals."""
        return (
            (Column("", 4), Column("", 14), Column("", 8), Column("")),
            [_row(goal) for goal in self.goals],
        )

    def answer(self) -> tuple[str, str, Mapping[str, Any] | tuple[str, str]]:
        """Return the chosen goal's result, or its newest feedback."""
        goal = self.chosen
        if goal is None:
            return (
                _("Feedback and result"),
                self.name_shown,
                (
                    _("no goal was sent yet"),
                    _("{key} sends what is filled in.").format(key=self.submit_key),
                ),
            )
        name = f"{self.name_shown} {goal.number}"
        state = f"#{goal.number} {_words(goal)}"
        if goal.error:
            return state, name, (_(STATES[goal.status][1]), plain(said(goal.error), LONGEST))
        if goal.result is not None:
            return f"{state} · " + _("result"), f"{name} result", goal.result
        if goal.feedback is not None:
            count = _("feedback {n}").format(n=goal.feedbacks)
            return f"{state} · {count}", name, goal.feedback
        return state, name, (_("no feedback yet"), "")

    def ask(self, value: Mapping[str, Any]) -> None:
        """Send a goal."""
        graph = self.deck.feed.graph
        if graph is not None:
            future = graph.send_goal(self.name_shown, self.type_names()[0], value)
            self.run_worker(self._sent(future), exit_on_error=False)

    async def _sent(self, future: Future[int]) -> None:
        try:
            number = await asyncio.wrap_future(future)
        except Exception as error:  # noqa: BLE001 - whatever it was, it is told
            reason = said(getattr(error, "words", str(error)))
            self.warn(_("Not sent: {reason}").format(reason=reason))
            return
        self._sent_newest = number
        self.redraw()

    def redraw(self) -> None:
        """Show the goals, and choose the one that was just sent."""
        super().redraw()
        if self._sent_newest in [goal.number for goal in self.goals]:
            self.asked_rows.choose(str(self._sent_newest))
            self._sent_newest = None

    @property
    def can_cancel(self) -> bool:
        """Whether the chosen goal, or else any, has not ended."""
        return any(not goal.ended for goal in self.goals)

    @property
    def is_waiting(self) -> bool:
        """Updates of the graph count the seconds."""
        return False

    def cancel(self) -> None:
        """Cancel the chosen goal; if that one has ended, the newest that has not."""
        graph, goal = self.deck.feed.graph, self.chosen
        if goal is None or goal.ended:
            goal = next((one for one in self.goals if not one.ended), None)
        if graph is not None and goal is not None:
            graph.cancel_goal(goal.number)

    @property
    def can_forget(self) -> bool:
        """Whether a goal is chosen."""
        return self.chosen is not None

    def forget(self) -> None:
        """Take the chosen goal off the list."""
        graph, goal = self.deck.feed.graph, self.chosen
        if graph is not None and goal is not None:
            graph.forget_goal(goal.number)


def _words(goal: Goal) -> str:
    sign, word, _meaning = STATES[goal.status]
    return f"{sign} {_(word)}"


def _row(goal: Goal) -> Row:
    told = ngettext("{n} feedback", "{n} feedbacks", goal.feedbacks).format(n=goal.feedbacks)
    if goal.error:
        told = plain(said(goal.error), LONGEST)
    cells = (
        Cell(f"#{goal.number}"),
        Cell(_words(goal), STATES[goal.status][2]),
        Cell(_("{n} s").format(n=figure(goal.elapsed_s, 1)), "dim"),
        Cell(told, "dim"),
    )
    return Row(str(goal.number), cells)
