"""Recording the session, and the recordings there are, from any screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text import ros2_words
from text.i18n import N_
from tui.actions.action import Action
from tui.frame.actions.ros2 import copy_command

if TYPE_CHECKING:
    from tui.frame.host import Host


class RecordToggle(Action["Host"]):
    """Start recording, or stop."""

    id = "recording.toggle"
    key = "f6"
    title = N_("Record")
    tooltip = N_("Record into a folder that `ros2 bag` and `deck replay` read; it asks what first.")
    priority = True

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while a robot is shown, not a recording of one."""
        return target.feed.link is not None and target.feed.replay is None

    @classmethod
    def label(cls, target: Host) -> str:
        """Named after what it would do now."""
        return N_("End recording") if target.recording.active else cls.title

    @classmethod
    async def run(cls, target: Host) -> None:
        target.record()


class ShowRecordings(Action["Host"]):
    """List the recordings, to open one."""

    id = "recording.list"
    key = "shift+f6"
    title = N_("Recordings")
    tooltip = N_("The recordings on this machine: how long, how large, whether damaged; open one.")
    priority = True
    footer = True

    @classmethod
    def shown(cls, target: Host) -> bool:
        """Only beside the lessons: the keys of a session need the room."""
        return not target.feed.opened

    @classmethod
    async def run(cls, target: Host) -> None:
        target.show_recordings()


class RecordAsRos2(Action["Host"]):
    """Copy what records the same as a command line of `ros2`."""

    id = "recording.ros2"
    key = "alt+f6"
    title = N_("Record as ros2 command")
    tooltip = N_("Copy the `ros2 bag record` that records the same from a shell, and show it.")
    priority = True

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only where something could be recorded."""
        return RecordToggle.possible(target)

    @classmethod
    async def run(cls, target: Host) -> None:
        copy_command(target, ros2_words.record())


RECORDING_ACTIONS = (RecordToggle, ShowRecordings, RecordAsRos2)
