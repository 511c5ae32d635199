"""Recording what runs, from any screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tui.actions.action import Action
from tui.i18n import N_

if TYPE_CHECKING:
    from tui.app import DeckApp


class RecordToggle(Action["DeckApp"]):
    """Begin to record, or end it."""

    id = "recording.toggle"
    key = "f6"
    title = N_("Record")
    tooltip = N_("Record all topics into a folder that `ros2 bag` and `deck replay` read.")
    priority = True

    @classmethod
    def possible(cls, target: DeckApp) -> bool | None:
        """Only while a robot is shown, not its recording."""
        return target.feed.link is not None and target.feed.replay is None

    @classmethod
    def label(cls, target: DeckApp) -> str:
        """By what it would do now."""
        return N_("End recording") if target.recording.active else cls.title

    @classmethod
    async def run(cls, target: DeckApp) -> None:
        """Begin, or end."""
        target.recording.toggle()


RECORDING_ACTIONS = (RecordToggle,)
