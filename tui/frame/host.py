"""What screens, dialogs and actions need of the app that shows them.

They ask `host_of` for it and import no `tui.app`; the app fits by its shape.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, cast

if TYPE_CHECKING:
    from textual.dom import DOMNode
    from textual.notifications import SeverityLevel

    from tui.actions import Action
    from tui.emergency.control import EmergencyControl
    from tui.recording.recording import Recording
    from tui.session.feed import Feed
    from tui.session.ports import SessionOpener
    from tui.session.requests import OpenRequest
    from tui.session.strangers import Strangers
    from tui.terminal.stall_detector import KeyStallDetector


class SessionDoor(Protocol):
    """The way into a session and out of it."""

    request: OpenRequest
    """What every request has: hardware, overrides, domain; and what was named to begin with."""

    @property
    def opener(self) -> SessionOpener:
        """Lists what can be opened, and opens it."""

    @property
    def opening(self) -> str:
        """What is being opened, empty if nothing is."""

    @property
    def last_lesson(self) -> str:
        """The profile that was started last, where the list of lessons begins."""

    def open(self, request: OpenRequest) -> None:
        """Start or attach to a session and show it until it ends."""

    def close(self) -> None:
        """Stop the nodes that this screen has started, or let go of the others; then pick anew."""

    def leave(self, code: int = 0) -> None:
        """Stop what this screen has started, and end with `code`; asked again, at once."""

    def end_of_others(self) -> None:
        """Stop a session that was started elsewhere, if a person says so once more."""

    def stop_now(self) -> None:
        """Skip the waiting for nodes that do not end by themselves."""

    def tell_damage(self, words: str) -> None:
        """Say that something in the recording cannot be read, when that is first come to."""


class KeyNames(Protocol):
    """Knows by which keys things are done."""

    def keys_of(self, action: type[Action[Any]]) -> list[str]:
        """Return how the keys of `action` are written, those of the user's keymap."""


class Host(KeyNames, Protocol):
    """The app."""

    @property
    def feed(self) -> Feed:
        """The session and its graph."""

    @property
    def sessions(self) -> SessionDoor:
        """The way into a session and out of it."""

    @property
    def emergency(self) -> EmergencyControl:
        """The emergency stop: engaged and released here; its `state` is what is shown."""

    @property
    def recording(self) -> Recording:
        """What is recorded of the session."""

    @property
    def strangers(self) -> Strangers:
        """Who publishes what only the gate and the differential should."""

    @property
    def stall_detector(self) -> KeyStallDetector:
        """Knows for how long the screen has stood still."""

    async def show_screen(self, name: str) -> None:
        """Bring the screen of this name to the front."""

    def show_help(self) -> None:
        """Explain the screen in front."""

    def show_palette(self) -> None:
        """Open the palette."""

    def replay_changed(self) -> None:
        """Show at once where the recording is now."""

    def speak(self, code: str) -> None:
        """Speak this language from now on."""

    def switch_language(self) -> None:
        """Speak the next language."""

    def next_theme(self) -> None:
        """Take the next theme."""

    def redraw(self) -> None:
        """Draw everything anew."""

    def notify(
        self,
        message: str,
        *,
        title: str = "",
        severity: SeverityLevel = "information",
        timeout: float | None = None,
        markup: bool = False,
    ) -> None:
        """Tell something in a corner."""


def host_of(node: DOMNode) -> Host:
    """Return the app that shows `node`."""
    return cast("Host", node.app)
