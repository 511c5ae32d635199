"""What can be done on the screen of the graph; each letter also under its Cyrillic key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.graph.ask import AskPane
    from tui.graph.node import NodePane
    from tui.session.feed import Feed


class GraphTarget(Protocol):
    """What these actions need of the screen of the graph."""

    @property
    def feed(self) -> Feed:
        """What runs."""

    @property
    def ask_pane(self) -> AskPane | None:
        """The detail in front, if something can be asked there."""

    @property
    def node_pane(self) -> NodePane | None:
        """The detail in front, if it is a node's."""

    @property
    def shows_pane(self) -> bool:
        """Whether the detail is seen."""

    @property
    def shows_parameters(self) -> bool:
        """Whether parameters are in front."""

    @property
    def is_in_list(self) -> bool:
        """Whether keys go to the list of names."""

    @property
    def is_typing(self) -> bool:
        """Whether letters go into a text."""

    @property
    def draws(self) -> bool:
        """Whether the drawing is in front."""

    def focus_filter(self) -> None:
        """Put the cursor into the filter."""

    def list_next(self, by: int) -> None:
        """List the kind that stands so many tabs to the right."""

    def toggle_map(self) -> None:
        """Draw the graph around the chosen node, or list it again."""

    def toggle_everything(self) -> None:
        """Show or hide what ROS itself needs."""

    def save_parameters(self) -> None:
        """Ask for a file, and write the node's parameters into it."""

    def load_parameters(self) -> None:
        """Ask for a file, and set what it has for the node."""

    def go_back(self) -> None:
        """Go back to where the newest link was followed, else to the list."""


class GraphAction(Action[GraphTarget]):
    """Something that the screen of the graph does."""


class FillIn(GraphAction):
    """Into the form, past the names above it that lead elsewhere.

    First, so that the footer of a small terminal has room for it.
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
        """Not in the room of what cancels, while something is under way."""
        return target.ask_pane is not None and not target.ask_pane.can_cancel

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Go to its first line."""
        if target.ask_pane is not None:
            target.ask_pane.first().focus()


class FilterNames(GraphAction):
    """Narrow the list down."""

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
        """Not where a slash is a slash."""
        return not target.is_typing

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Put the cursor into the filter."""
        target.focus_filter()


class NextKind(GraphAction):
    """Services after nodes, and so on."""

    id = "graph.next"
    key = "right"
    title = N_("Next kind")
    tooltip = N_("List the next kind: nodes, services, actions, types.")
    from_elsewhere = True

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """List it."""
        target.list_next(1)


class PreviousKind(GraphAction):
    """The other way round."""

    id = "graph.previous"
    key = "left"
    title = N_("Previous kind")
    tooltip = N_("List the kind before: types, actions, services, nodes.")
    from_elsewhere = True

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """List it."""
        target.list_next(-1)


class ShowMap(GraphAction):
    """The graph drawn."""

    id = "graph.map"
    key = "M,Ь"
    title = N_("Map")
    tooltip = N_("Draw the chosen node with those that it talks to; arrows walk, Enter goes on.")
    footer = True
    from_elsewhere = True

    @classmethod
    def label(cls, target: GraphTarget) -> str:
        """By what it would do now."""
        return N_("List") if target.draws else cls.title

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Draw or list."""
        target.toggle_map()


class ShowParameters(GraphAction):
    """The node's parameters."""

    id = "graph.calls.parameters"
    key = "E,У"
    title = N_("Parameters")
    tooltip = N_("Read the parameters of the chosen node, or hide them; Enter changes one.")
    footer = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only of a node, which a recording is not."""
        if target.feed.replay is not None:
            return False
        return target.node_pane is not None and target.shows_pane

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Show or hide them."""
        if target.node_pane is not None:
            target.node_pane.toggle_parameters()


class ParametersAction(GraphAction):
    """Something that is done with the parameters that are shown."""

    footer = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only while they are shown."""
        return target.shows_parameters


class SaveParameters(ParametersAction):
    """Into a file."""

    id = "graph.save"
    key = "W,Ц"
    title = N_("Save")
    means = "write to a file"
    tooltip = N_("Save the node's parameters as YAML.")

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Ask for a file."""
        target.save_parameters()


class LoadParameters(ParametersAction):
    """From a file."""

    id = "graph.load"
    key = "O,Щ"
    title = N_("Load")
    tooltip = N_("Set the node's parameters from a YAML file.")

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Ask for a file."""
        target.load_parameters()


class SubmitRequest(GraphAction):
    """The call, or the goal, from wherever the focus is."""

    id = "graph.ask"
    key = "ctrl+s"
    title = N_("Call")
    means = "submit"
    tooltip = N_("Call the service, or send the goal, with what is filled in.")
    footer = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only where a form is seen: what it asks for may turn wheels."""
        return target.ask_pane is not None and target.shows_pane

    @classmethod
    def label(cls, target: GraphTarget) -> str:
        """By what would be asked."""
        return cls.title if target.ask_pane is None else target.ask_pane.submit_title

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Ask."""
        if target.ask_pane is not None:
            target.ask_pane.form.submit()


class CancelRequest(GraphAction):
    """What is under way."""

    id = "graph.cancel"
    key = "f12,x,ч"
    title = N_("Cancel")
    means = "stop"
    tooltip = N_("Stop waiting for the call, or cancel the chosen goal; asks first for others'.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only while something is under way."""
        return target.ask_pane is not None and target.ask_pane.can_cancel

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Cancel it."""
        if target.ask_pane is not None:
            target.ask_pane.cancel()


class ForgetGoal(GraphAction):
    """Off the list."""

    id = "graph.forget"
    key = "delete,d,в"
    title = N_("Forget")
    means = "clear"
    tooltip = N_("Take the chosen goal off the list; one that has not ended is cancelled.")

    @classmethod
    def possible(cls, target: GraphTarget) -> bool | None:
        """Only of an action whose goals are seen."""
        pane = target.ask_pane
        return pane is not None and pane.can_forget and target.shows_pane

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Forget it."""
        if target.ask_pane is not None:
            target.ask_pane.forget()


class ShowEverything(GraphAction):
    """What ROS itself needs."""

    id = "graph.housekeeping"
    key = "a,ф"
    title = N_("All")
    means = "all"
    tooltip = N_("Show or hide what ROS itself needs: parameter services, hidden nodes.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Show or hide it."""
        target.toggle_everything()


class GoBack(GraphAction):
    """To where one came from."""

    id = "graph.back"
    key = "escape,backspace"
    title = N_("Back")
    tooltip = N_("From the detail to the list, from there back along the links.")

    @classmethod
    async def run(cls, target: GraphTarget) -> None:
        """Go back."""
        target.go_back()


GRAPH_ACTIONS = (
    FillIn,
    FilterNames,
    ShowMap,
    ShowParameters,
    SaveParameters,
    LoadParameters,
    SubmitRequest,
    CancelRequest,
    ForgetGoal,
    ShowEverything,
    NextKind,
    PreviousKind,
    GoBack,
)
