"""The actions of the Graph screen; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from text.i18n import N_
from tui.graph.node_actions import ChangeLevel, ChangeLifecycle
from tui.graph.target import GraphAction, GraphTarget


class FillIn(GraphAction):
    """Go into the form, past the names above it that are links.

    Listed first, so that the footer of a small terminal has room for it.
    """

    id = "graph.fill_in"
    key = "tab"
    title = N_("Fill in")
    tooltip = N_("Go into the form of the service or action; Escape comes back to the list.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only in the list, beside a form."""
        return target.ask_pane is not None and target.shows_pane and target.is_in_list

    @classmethod
    def shown(cls, target: GraphTarget) -> bool:
        """Not while a request is in progress, which needs the room for its cancel key."""
        return target.ask_pane is not None and not target.ask_pane.can_cancel

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Focus its first line."""
        if target.ask_pane is not None:
            target.ask_pane.first().focus()


class FilterNames(GraphAction):
    """Filter the list."""

    id = "graph.filter"
    key = "slash,ctrl+f"
    title = N_("Filter")
    means = "find"
    tooltip = N_("Show only what has the words that you type in its name or type.")
    footer = True
    priority = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Not in a text field, where a slash is typed."""
        return not target.is_typing

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        target.focus_filter()


class NextKind(GraphAction):
    """Switch from nodes to services, and so on."""

    id = "graph.next"
    key = "right"
    title = N_("Next kind")
    means = "the tab to the right"
    tooltip = N_("List the next kind: nodes, services, actions, types, findings.")
    from_elsewhere = True

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        target.list_next(1)


class PreviousKind(GraphAction):
    """Switch in the other direction."""

    id = "graph.previous"
    key = "left"
    title = N_("Previous kind")
    means = "the tab to the left"
    tooltip = N_("List the previous kind: findings, types, actions, services, nodes.")
    from_elsewhere = True

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        target.list_next(-1)


class ShowMap(GraphAction):
    """Show the map."""

    id = "graph.map"
    key = "M,Ь"
    title = N_("Map")
    tooltip = N_("Draw the selected node with those that it talks to; the arrow keys move, Enter opens.")
    footer = True
    from_elsewhere = True

    @classmethod
    def label(cls, target: GraphTarget) -> str:
        """Named after what it would do now."""
        return N_("List") if target.draws else cls.title

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        target.toggle_map()


class ShowParameters(GraphAction):
    """Show the node's parameters."""

    id = "graph.calls.parameters"
    key = "E,У"
    title = N_("Parameters")
    tooltip = N_("Read the parameters of the selected node, or hide them; Enter changes one.")
    footer = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only for a node, and not in a recording."""
        if target.feed.replay is not None:
            return False
        return target.node_pane is not None and target.shows_pane

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        if target.node_pane is not None:
            target.node_pane.toggle_parameters()


class ParametersAction(GraphAction):
    """An action on the parameters that are shown."""

    footer = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only while they are shown."""
        return target.shows_parameters


class SaveParameters(ParametersAction):
    """Save them to a file."""

    id = "graph.save"
    key = "W,Ц"
    title = N_("Save")
    means = "write to a file"
    tooltip = N_("Save the node's parameters as YAML.")

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        if target.node_pane is not None:
            target.node_pane.save_parameters()


class LoadParameters(ParametersAction):
    """Load them from a file."""

    id = "graph.load"
    key = "O,Щ"
    title = N_("Load")
    tooltip = N_("Set the node's parameters from a YAML file.")

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        if target.node_pane is not None:
            target.node_pane.load_parameters()


class SubmitRequest(GraphAction):
    """Send the call or the goal, wherever the focus is."""

    id = "graph.ask"
    key = "ctrl+s"
    title = N_("Call")
    means = "submit"
    tooltip = N_("Call the service, or send the goal, with what is filled in.")
    footer = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only where a form is visible: the request may turn wheels."""
        return target.ask_pane is not None and target.shows_pane

    @classmethod
    def label(cls, target: GraphTarget) -> str:
        """Named after what would be sent."""
        return cls.title if target.ask_pane is None else target.ask_pane.submit_title

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        if target.ask_pane is not None:
            target.ask_pane.form.submit()


class CancelRequest(GraphAction):
    """Cancel the request in progress."""

    id = "graph.cancel"
    key = "f12,x,ч"
    title = N_("Cancel")
    means = "stop"
    tooltip = N_("Stop waiting for the call, or cancel the selected goal; asks first if it is another client's.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only while a request is in progress."""
        return target.ask_pane is not None and target.ask_pane.can_cancel

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        if target.ask_pane is not None:
            target.ask_pane.cancel()


class ForgetGoal(GraphAction):
    """Remove a goal from the list."""

    id = "graph.forget"
    key = "delete,d,в"
    title = N_("Forget")
    means = "clear"
    tooltip = N_("Remove the selected goal from the list; one that has not ended is cancelled.")

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only for an action whose goals are visible."""
        pane = target.ask_pane
        return pane is not None and pane.can_forget and target.shows_pane

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        if target.ask_pane is not None:
            target.ask_pane.forget()


class ShowEverything(GraphAction):
    """Show what belongs to ROS itself."""

    id = "graph.housekeeping"
    key = "a,ф"
    title = N_("All")
    means = "all"
    tooltip = N_("Show or hide what ROS itself needs: parameter services, hidden nodes.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        target.toggle_everything()


class GoBack(GraphAction):
    """Go back to the previous place."""

    id = "graph.back"
    key = "escape,backspace"
    title = N_("Back")
    tooltip = N_("From the detail to the list, from there back along the links.")

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        target.go_back()


GRAPH_ACTIONS = (
    FillIn,
    ChangeLifecycle,
    FilterNames,
    ShowMap,
    ShowParameters,
    SaveParameters,
    LoadParameters,
    ChangeLevel,
    SubmitRequest,
    CancelRequest,
    ForgetGoal,
    ShowEverything,
    NextKind,
    PreviousKind,
    GoBack,
)
