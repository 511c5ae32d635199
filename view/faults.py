"""What keeps a viewer from showing anything."""

from __future__ import annotations

from text.sentences import say


class ViewError(Exception):
    """Why there is no viewer; its text is a sentence for the user, with the fix."""


class PortTakenError(ViewError):
    """Another program listens at the port that was asked for."""

    def __init__(self, port: int) -> None:
        super().__init__(say("port {port} is taken: choose another one with --port, or none", port=port))
