"""The same as a command line of `ros2`, from a dialog, which the app's own key cannot reach."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Announce
from tui.frame.actions.ros2 import copy_as_ros2, copy_command

if TYPE_CHECKING:
    from tui.frame.host import Host

action: Announce[Pastable] = Announce()


class Pastable(Protocol):
    """A dialog whose form `ros2` could send as well."""

    @property
    def deck(self) -> Host:
        """The app."""

    async def ros2_command(self) -> str:
        """Return what is filled in as a command line of `ros2`, empty if it is not valid."""


@action(
    "app.ros2_dialog",
    "alt+y",
    copy_as_ros2.title,
    N_("Copy what is filled in as a `ros2` command for a shell, and show it."),
    priority=True,
    palette=False,
)
async def copy_dialog_as_ros2(screen: Pastable) -> None:
    copy_command(screen.deck, await screen.ros2_command())
