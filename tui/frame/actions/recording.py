"""Recording what runs, from any screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.frame.host import Host


class RecordToggle(Action["Host"]):
    """Begin to record, or end it."""

    id = "recording.toggle"
    key = "f6"
    title = N_("Record")
    tooltip = N_("Record all topics into a folder that `ros2 bag` and `deck replay` read.")
    priority = True

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while a robot is shown, not its recording."""
        return target.feed.link is not None and target.feed.replay is None

    @classmethod
    def label(cls, target: Host) -> str:
        """By what it would do now."""
        return N_("End recording") if target.recording.active else cls.title

    @classmethod
    async def run(cls, target: Host) -> None:
        """Begin, or end."""
        target.recording.toggle()


class RecordWithoutImages(Action["Host"]):
    """Begin to record all but pictures, which are most of what a robot with a camera says."""

    id = "recording.without_images"
    key = "shift+f6"
    title = N_("Record without images")
    tooltip = N_("Record all topics but those of pictures; F6 ends it.")
    priority = True
    footer = False

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while nothing is recorded yet."""
        return RecordToggle.possible(target) and not target.recording.active

    @classmethod
    async def run(cls, target: Host) -> None:
        """Begin."""
        target.recording.toggle(images=False)


RECORDING_ACTIONS = (RecordToggle, RecordWithoutImages)
