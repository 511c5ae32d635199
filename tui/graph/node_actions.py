"""The actions on the node that is chosen in the Graph screen."""

from __future__ import annotations

from text.i18n import N_
from tui.graph.target import GraphAction, GraphTarget


class ChangeLifecycle(GraphAction):
    """Have a node make a transition."""

    id = "graph.lifecycle"
    key = "J,О"
    title = N_("Lifecycle")
    tooltip = N_("Configure, activate or shut down the selected node, if it has a lifecycle.")
    footer = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only for a node that can change now."""
        pane = target.node_pane
        return pane is not None and pane.can_change and target.shows_pane

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Offer what is possible now."""
        if target.node_pane is not None:
            target.node_pane.change_lifecycle()


class ChangeLevel(GraphAction):
    """Change how much a node logs."""

    id = "graph.level"
    key = "K,Л"
    title = N_("Log level")
    tooltip = N_("Read from which severity on the selected node logs, and change it.")

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only for a node, and not in a recording."""
        if target.feed.replay is not None:
            return False
        return target.node_pane is not None and target.shows_pane

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Ask the node, then the user."""
        if target.node_pane is not None:
            target.node_pane.change_level()
