"""The same as a command line of `ros2`, from any screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_, _
from text.plain import plain
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.frame.host import Host

LONGEST = 400
SHOWN_S = 12.0
"""Long enough to read a command line and to type it."""


def copy_command(host: Host, command: str) -> None:
    """Copy a command line to the clipboard of the terminal, and show it."""
    if not command:
        words = _("There is no ros2 command for this.")
        host.notify(words, severity="warning", markup=False)
        return
    host.copy_to_clipboard(command)
    host.notify(plain(command, LONGEST), title=_("Copied for a shell"), timeout=SHOWN_S, markup=False)


class CopyAsRos2(Action["Host"]):
    """Copy what is shown or chosen as a command line of `ros2`."""

    id = "app.ros2"
    key = "Y,Н,alt+y"
    title = N_("As ros2 command")
    tooltip = N_("Copy what is selected or filled in as a `ros2` command for a shell, and show it.")
    priority = True

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only on a screen of a session."""
        return target.feed.opened and target.feed.front is not None

    @classmethod
    async def run(cls, target: Host) -> None:
        if target.feed.front is not None:
            copy_command(target, await target.feed.front.ros2_command())
