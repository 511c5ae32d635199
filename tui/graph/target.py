"""What the actions of the Graph screen act on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.graph.ask import AskPane
    from tui.graph.node import NodePane
    from tui.session.feed import Feed


class GraphTarget(Protocol):
    """The part of the Graph screen that its actions use."""

    @property
    def feed(self) -> Feed:
        """The session."""

    @property
    def ask_pane(self) -> AskPane | None:
        """The current detail, if it has a form."""

    @property
    def node_pane(self) -> NodePane | None:
        """The current detail, if it is that of a node."""

    @property
    def shows_pane(self) -> bool:
        """Whether the detail is visible."""

    @property
    def shows_parameters(self) -> bool:
        """Whether parameters are shown."""

    @property
    def is_in_list(self) -> bool:
        """Whether the list of names has the focus."""

    @property
    def is_typing(self) -> bool:
        """Whether letters are typed into a text field."""

    @property
    def draws(self) -> bool:
        """Whether the map is shown."""

    def focus_filter(self) -> None:
        """Focus the filter."""

    def list_next(self, by: int) -> None:
        """List the kind this many tabs to the right."""

    def toggle_map(self) -> None:
        """Show the map around the chosen node, or the list."""

    def toggle_everything(self) -> None:
        """Show or hide what belongs to ROS itself."""

    def go_back(self) -> None:
        """Go back to where the last link was followed, otherwise to the list."""


class GraphAction(Action[GraphTarget]):
    """An action of the Graph screen."""
