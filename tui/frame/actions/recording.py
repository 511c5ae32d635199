"""Recording the session, and the recordings there are, from any screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text import ros2_words
from text.i18n import N_
from tui.actions.action import Announce, actions_of
from tui.frame.actions.ros2 import copy_command

if TYPE_CHECKING:
    from tui.frame.host import Host

action: Announce[Host] = Announce()


@action(
    "recording.toggle",
    "f6",
    N_("Record"),
    N_("Record into a folder that `ros2 bag` and `deck replay` read; it asks what first."),
    priority=True,
    when=lambda host: host.feed.link is not None and host.feed.replay is None,
    label=lambda host: N_("End recording") if host.recording.active else N_("Record"),
)
def record_toggle(host: Host) -> None:
    host.record()


@action(
    "recording.list",
    "shift+f6",
    N_("Recordings"),
    N_("The recordings on this machine: how long, how large, whether damaged; open one."),
    footer=True,
    priority=True,
    shown=lambda host: not host.feed.opened,
)
def show_recordings(host: Host) -> None:
    host.show_recordings()


@action(
    "recording.ros2",
    "alt+f6",
    N_("Record as ros2 command"),
    N_("Copy the `ros2 bag record` that records the same from a shell, and show it."),
    priority=True,
    when=record_toggle.possible,
)
def record_as_ros2(host: Host) -> None:
    copy_command(host, ros2_words.record())


RECORDING_ACTIONS = actions_of(__name__)
