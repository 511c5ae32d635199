"""Recording the session, from any screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Action

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


RECORDING_ACTIONS = (RecordToggle, RecordWithoutImages)
