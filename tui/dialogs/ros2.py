"""The same as a command line of `ros2`, from a dialog, which the app's own key cannot reach."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action
from tui.frame.actions.ros2 import CopyAsRos2, copy_command

if TYPE_CHECKING:
    from tui.frame.host import Host


class Pastable(Protocol):
    """A dialog whose form `ros2` could send as well."""

    @property
    def deck(self) -> Host:
        """The app."""

    async def ros2_command(self) -> str:
        """Return what is filled in as a command line of `ros2`, empty if it is not valid."""


class CopyDialogAsRos2(Action[Pastable]):
    """Copy what is filled in as a command line of `ros2`."""

    id = "app.ros2_dialog"
    key = "alt+y"
    title = CopyAsRos2.title
    tooltip = N_("Copy what is filled in as a `ros2` command for a shell, and show it.")
    priority = True
    palette = False

    @classmethod
    async def run(cls, target: Pastable) -> None:
        copy_command(target.deck, await target.ros2_command())
