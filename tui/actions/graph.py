"""What can be done on the screen of the graph; each letter also under its Cyrillic key."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tui.actions.action import Action
from tui.i18n import N_
from tui.screens import graph_parameters

if TYPE_CHECKING:
    from tui.screens.graph import GraphScreen


class GraphAction(Action["GraphScreen"]):
    """Something that the screen of the graph does."""


class Filter(GraphAction):
    """Narrow the list down."""

    id = "graph.filter"
    key = "slash,ctrl+f"
    title = N_("Filter")
    tooltip = N_("Show only what has the words that you type in its name or type.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: GraphScreen) -> bool | None:
        """Not where a slash is a slash."""
        return not target.is_typing

    @classmethod
    async def run(cls, target: GraphScreen) -> None:
        """Put the cursor into the filter."""
        target.focus_filter()


class NextKind(GraphAction):
    """Services after nodes, and so on."""

    id = "graph.next"
    key = "right"
    title = N_("Next kind")
    tooltip = N_("List the next kind: nodes, services, actions, types.")

    @classmethod
    async def run(cls, target: GraphScreen) -> None:
        """List it."""
        target.list_next(1)


class PreviousKind(GraphAction):
    """The other way round."""

    id = "graph.previous"
    key = "left"
    title = N_("Previous kind")
    tooltip = N_("List the kind before: types, actions, services, nodes.")

    @classmethod
    async def run(cls, target: GraphScreen) -> None:
        """List it."""
        target.list_next(-1)


class Parameters(GraphAction):
    """The node's parameters."""

    id = "graph.parameters"
    key = "p,з"
    title = N_("Parameters")
    tooltip = N_("Read the parameters of the chosen node, or hide them; Enter changes one.")
    footer = True

    @classmethod
    def possible(cls, target: GraphScreen) -> bool | None:
        """Only of a node."""
        return target.node_pane is not None

    @classmethod
    async def run(cls, target: GraphScreen) -> None:
        """Show or hide them."""
        if target.node_pane is not None:
            target.node_pane.toggle_parameters()


class ParametersAction(GraphAction):
    """Something that is done with the parameters that are shown."""

    footer = True

    @classmethod
    def possible(cls, target: GraphScreen) -> bool | None:
        """Only while they are shown."""
        return target.node_pane is not None and target.node_pane.shows_parameters


class SaveParameters(ParametersAction):
    """Into a file."""

    id = "graph.save"
    key = "w,ц"
    title = N_("Save")
    tooltip = N_("Save the node's parameters as YAML.")

    @classmethod
    async def run(cls, target: GraphScreen) -> None:
        """Ask for a file."""
        if target.node_pane is not None:
            graph_parameters.save(target.deck, target.node_pane.parameters)


class LoadParameters(ParametersAction):
    """From a file."""

    id = "graph.load"
    key = "o,щ"
    title = N_("Load")
    tooltip = N_("Set the node's parameters from a YAML file.")

    @classmethod
    async def run(cls, target: GraphScreen) -> None:
        """Ask for a file."""
        if target.node_pane is not None:
            graph_parameters.load(target.deck, target.node_pane.parameters)


class Housekeeping(GraphAction):
    """What ROS itself needs."""

    id = "graph.housekeeping"
    key = "a,ф"
    title = N_("All")
    tooltip = N_("Show or hide what ROS itself needs: parameter services, hidden nodes.")
    footer = True

    @classmethod
    async def run(cls, target: GraphScreen) -> None:
        """Show or hide it."""
        target.toggle_everything()


class Back(GraphAction):
    """To where one came from."""

    id = "graph.back"
    key = "escape,backspace"
    title = N_("Back")
    tooltip = N_("From the detail to the list, from there back along the links.")

    @classmethod
    async def run(cls, target: GraphScreen) -> None:
        """Go back."""
        target.go_back()


GRAPH_ACTIONS = (
    Filter,
    Parameters,
    SaveParameters,
    LoadParameters,
    Housekeeping,
    NextKind,
    PreviousKind,
    Back,
)
