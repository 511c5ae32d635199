"""The same as a command line of `ros2`, from any screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_, _
from text.plain import plain
from tui.actions.action import Announce

if TYPE_CHECKING:
    from tui.frame.host import Host

action: Announce[Host] = Announce()

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


@action(
    "app.ros2",
    "Y,alt+y",
    N_("As ros2 command"),
    N_("Copy what is selected or filled in as a `ros2` command for a shell, and show it."),
    priority=True,
    when=lambda host: host.feed.opened and host.feed.front is not None,
)
async def copy_as_ros2(host: Host) -> None:
    if host.feed.front is not None:
        copy_command(host, await host.feed.front.ros2_command())
