"""Shown while the nodes are being stopped: which ones are still running, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog
from tui.widgets.node_words import STATES, why

if TYPE_CHECKING:
    from textual.binding import BindingType

action: Announce[StoppingScreen] = Announce()


@action(
    "stopping.now",
    "q,ctrl+q,ctrl+c",
    N_("Stop at once"),
    N_("Kill what has not stopped yet."),
    means="leave",
    footer=True,
    priority=True,
    palette=False,
)
def stop_now(dialog: StoppingScreen) -> None:
    dialog.deck.sessions.stop_now()


class StoppingScreen(Dialog[None]):
    """A list of the nodes that are still running, updated a few times a second."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(stop_now)
    can_be_covered = False

    def on_mount(self) -> None:
        """Update the list until all have stopped."""
        self.set_interval(0.2, self.redraw)

    def title_words(self) -> str:
        return _("Stopping the nodes")

    def words(self) -> Content:
        """Return the nodes that are still running."""
        alive = [node for node in self.deck.feed.nodes.values() if node.state.alive]
        if not alive:
            return Content(_("All nodes have stopped."))
        lines = [Content(_("Dependants first; each has a few seconds to end by itself."))]
        for node in alive:
            sign, word, _meaning = STATES[node.state]
            lines.append(
                Content.assemble(
                    (f"{sign} {_(word):<14}", "$text-warning"),
                    (plain(node.name), "bold"),
                    (f"  {why(node)}", "$text-muted"),
                )
            )
        return Content("\n").join(lines)
