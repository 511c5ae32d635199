"""The robot in 3D, beside the screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce

if TYPE_CHECKING:
    from tui.frame.host import Host

action: Announce[Host] = Announce()


@action(
    "view.open",
    "alt+w",
    N_("3D"),
    N_("The robot in 3D, in a window of its own or in a browser: Rerun."),
    priority=True,
    when=lambda host: host.feed.link is not None and host.feed.replay is None,
)
def open_view(host: Host) -> None:
    host.view.open()
