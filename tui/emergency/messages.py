"""The emergency stop as a message to the screens."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.message import Message

if TYPE_CHECKING:
    from tui.emergency.state import Emergency


class EmergencyChanged(Message, bubble=False):
    """The emergency stop was engaged or released, or its details have changed."""

    def __init__(self, emergency: Emergency) -> None:
        super().__init__()
        self.emergency = emergency
