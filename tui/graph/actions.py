"""The actions of the Graph screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.graph.screen import GraphScreen

action: Announce[GraphScreen] = Announce()


@action(
    "graph.fill_in",
    "tab",
    N_("Fill in"),
    N_("Go into the form of the service or action; Escape comes back to the list."),
    footer=True,
    priority=True,
    when=lambda screen: screen.ask_pane is not None and screen.shows_pane and screen.focused is screen.names,
    shown=lambda screen: screen.ask_pane is not None and not screen.ask_pane.can_cancel,
)
def fill_in(screen: GraphScreen) -> None:
    if screen.ask_pane is not None:
        screen.ask_pane.first().focus()


def _may_change_state(screen: GraphScreen) -> bool | None:
    pane = screen.node_pane
    return pane is not None and bool(pane.transitions) and screen.shows_pane


@action(
    "graph.lifecycle",
    "J",
    N_("Lifecycle"),
    N_("Configure, activate or shut down the selected node, if it has a lifecycle."),
    footer=True,
    when=_may_change_state,
)
def change_lifecycle(screen: GraphScreen) -> None:
    if screen.node_pane is not None:
        screen.node_pane.change_lifecycle()


@action(
    "graph.filter",
    "slash,ctrl+f",
    N_("Filter"),
    N_("Show only what has the words that you type in its name or type."),
    means="find",
    footer=True,
    priority=True,
    anywhere=True,
    when=lambda screen: not screen.is_typing,
)
def filter_names(screen: GraphScreen) -> None:
    screen.set_focus(screen.filter)


def _shows_live_node(screen: GraphScreen) -> bool | None:
    if screen.feed.replay is not None:
        return False
    return screen.node_pane is not None and screen.shows_pane


@action(
    "graph.calls.parameters",
    "E",
    N_("Parameters"),
    N_("Read the parameters of the selected node, or hide them; Enter changes one."),
    footer=True,
    anywhere=True,
    when=_shows_live_node,
)
def show_parameters(screen: GraphScreen) -> None:
    if screen.node_pane is not None:
        screen.node_pane.toggle_parameters()


@action(
    "graph.save",
    "W",
    N_("Save"),
    N_("Save the node's parameters as YAML."),
    means="write to a file",
    footer=True,
    when=lambda screen: screen.shows_parameters,
)
def save_parameters(screen: GraphScreen) -> None:
    if screen.node_pane is not None:
        screen.node_pane.save_parameters()


@action(
    "graph.load",
    "O",
    N_("Load"),
    N_("Set the node's parameters from a YAML file."),
    footer=True,
    when=lambda screen: screen.shows_parameters,
)
def load_parameters(screen: GraphScreen) -> None:
    if screen.node_pane is not None:
        screen.node_pane.load_parameters()


@action(
    "graph.level",
    "K",
    N_("Log level"),
    N_("Read from which severity on the selected node logs, and change it."),
    when=_shows_live_node,
)
def change_level(screen: GraphScreen) -> None:
    if screen.node_pane is not None:
        screen.node_pane.change_level()


@action(
    "graph.ask",
    "ctrl+s",
    N_("Call"),
    N_("Call the service, or send the goal, with what is filled in."),
    means="submit",
    footer=True,
    when=lambda screen: screen.ask_pane is not None and screen.shows_pane,
    label=lambda screen: N_("Call") if screen.ask_pane is None else screen.ask_pane.submit_title,
)
def submit_request(screen: GraphScreen) -> None:
    if screen.ask_pane is not None:
        screen.ask_pane.form.submit()


@action(
    "graph.cancel",
    "f12,x",
    N_("Cancel"),
    N_("Stop waiting for the call, or cancel the selected goal; asks first if it is another client's."),
    means="stop",
    footer=True,
    priority=True,
    when=lambda screen: screen.ask_pane is not None and screen.ask_pane.can_cancel,
)
def cancel_request(screen: GraphScreen) -> None:
    if screen.ask_pane is not None:
        screen.ask_pane.cancel()


def _shows_own_goal(screen: GraphScreen) -> bool | None:
    pane = screen.ask_pane
    return pane is not None and pane.can_forget and screen.shows_pane


@action(
    "graph.forget",
    "delete,d",
    N_("Forget"),
    N_("Remove the selected goal from the list; one that has not ended is cancelled."),
    means="clear",
    when=_shows_own_goal,
)
def forget_goal(screen: GraphScreen) -> None:
    if screen.ask_pane is not None:
        screen.ask_pane.forget()


@action(
    "graph.housekeeping",
    "a",
    N_("All"),
    N_("Show or hide what ROS itself needs: parameter services, hidden nodes."),
    means="all",
    footer=True,
    anywhere=True,
)
def show_everything(screen: GraphScreen) -> None:
    screen.toggle_everything()


@action(
    "graph.next",
    "right",
    N_("Next kind"),
    N_("List the next kind: nodes, services, actions, types, findings."),
    means="the tab to the right",
    anywhere=True,
)
def next_kind(screen: GraphScreen) -> None:
    screen.list_next(1)


@action(
    "graph.previous",
    "left",
    N_("Previous kind"),
    N_("List the previous kind: findings, types, actions, services, nodes."),
    means="the tab to the left",
    anywhere=True,
)
def previous_kind(screen: GraphScreen) -> None:
    screen.list_next(-1)


@action(
    "graph.back", "escape,backspace", N_("Back"), N_("From the detail to the list, from there back along the links.")
)
def go_back(screen: GraphScreen) -> None:
    screen.go_back()


GRAPH_ACTIONS = actions_of(__name__)
