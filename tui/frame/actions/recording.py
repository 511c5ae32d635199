"""Recording the session, from any screen."""

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
    tooltip = N_("Record all topics into a folder that `ros2 bag` and `deck replay` read.")
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
        """Start, or stop."""
        target.recording.toggle()


class RecordWithoutImages(Action["Host"]):
    """Start recording everything but images, which are most of the data if there is a camera."""

    id = "recording.without_images"
    key = "shift+f6"
    title = N_("Record without images")
    tooltip = N_("Record all topics but those of pictures; F6 ends it.")
    priority = True
    footer = False

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while nothing is being recorded."""
        return RecordToggle.possible(target) and not target.recording.active

    @classmethod
    async def run(cls, target: Host) -> None:
        """Start."""
        target.recording.toggle(images=False)


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
        """Copy it."""
        copy_command(target, ros2_words.record())


RECORDING_ACTIONS = (RecordToggle, RecordWithoutImages, RecordAsRos2)
