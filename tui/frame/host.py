"""The part of the app that screens, dialogs and actions may use.

They get it from `host_of` and do not import `tui.app`; the app matches it structurally.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, cast

if TYPE_CHECKING:
    from textual.dom import DOMNode
    from textual.notifications import SeverityLevel

    from tui.actions import Action, Keys
    from tui.agents.control import AgentControl
    from tui.emergency.control import EmergencyControl
    from tui.recording.recording import Recording
    from tui.session.bypass import BypassDetector
    from tui.session.feed import Feed
    from tui.session.ports import SessionOpener
    from tui.session.requests import OpenRequest
    from tui.terminal.stall_detector import KeyStallDetector


class SessionControl(Protocol):
    """Opens and closes sessions."""

    request: OpenRequest
    """Hardware, overrides and domain for every request, and the profile named at the start."""

    @property
    def opener(self) -> SessionOpener:
        """Lists the sessions that can be opened, and opens them."""

    @property
    def opening(self) -> str:
        """Name of the session that is being opened, empty if there is none."""

    @property
    def last_lesson(self) -> str:
        """The profile that was started last, where the list of lessons starts."""

    def open(self, request: OpenRequest) -> None:
        """Start or attach to a session, and show it until it ends."""

    def move_to(self, request: OpenRequest) -> None:
        """Close the session on the screen, and open another."""

    def close(self) -> None:
        """Stop the nodes that this screen started, or detach from others; then show the picker."""

    def leave(self, code: int = 0) -> None:
        """Stop what this screen has started, and exit with `code`; if asked again, exit at once."""

    def end_of_others(self) -> None:
        """Stop a session that was started elsewhere, after the user confirms."""

    def stop_now(self) -> None:
        """Stop waiting for nodes that do not end by themselves."""

    def tell_damage(self, words: str) -> None:
        """Report that part of the recording cannot be read, when playback first gets there."""


class SharedLesson(Protocol):
    """The session's lesson, which several screens show; it is `tui.lesson.at_work`."""

    beside_nodes: bool
    """Whether it is wished beside the nodes on the Deck, too."""


class BesideView(Protocol):
    """The viewer beside the screen."""

    def open(self) -> None:
        """Open it, or say where it is open."""


class KeyNames(Protocol):
    """Knows which keys run which actions."""

    def keys_of(self, action: Action[Any] | Keys) -> list[str]:
        """Return how the keys of `action` are written, following the user's keymap."""


class Host(KeyNames, Protocol):
    """The app."""

    @property
    def feed(self) -> Feed:
        """The session and its graph."""

    @property
    def sessions(self) -> SessionControl:
        """Opens and closes sessions."""

    @property
    def emergency(self) -> EmergencyControl:
        """The emergency stop: engaged and released here; its `state` is shown."""

    @property
    def agents(self) -> AgentControl:
        """The questions of agents, and how they are answered."""

    @property
    def recording(self) -> Recording:
        """The recording of the session."""

    @property
    def view(self) -> BesideView:
        """The viewer in 3D beside the screen."""

    @property
    def bypass(self) -> BypassDetector:
        """Finds publishers on topics that only the gate and the differential should publish."""

    @property
    def stall_detector(self) -> KeyStallDetector:
        """Knows for how long the screen was stalled."""

    lesson: SharedLesson | None
    """What is shown of the session's lesson, once something has shown it."""

    editor: str
    """The editor that the user has chosen, empty if they were not asked yet."""

    def use_editor(self, name: str) -> None:
        """Use this editor from now on."""

    @property
    def terminal_fd(self) -> int:
        """The descriptor of the terminal."""

    async def show_screen(self, name: str) -> None:
        """Bring the screen of this name to the front."""

    def record(self) -> None:
        """Ask what to record, and start; or stop what is being recorded."""

    def show_recordings(self) -> None:
        """List the recordings on this machine."""

    def show_help(self) -> None:
        """Open the help page of the screen in front."""

    def show_tour(self) -> None:
        """Show the tour of the first start."""

    def show_palette(self) -> None:
        """Open the palette."""

    def replay_changed(self) -> None:
        """Show at once the new position in the recording."""

    def speak(self, code: str) -> None:
        """Switch to this language."""

    def switch_language(self) -> None:
        """Switch to the next language."""

    def next_theme(self) -> None:
        """Switch to the next theme."""

    def redraw(self) -> None:
        """Redraw everything."""

    def copy_to_clipboard(self, text: str) -> None:
        """Copy text to the clipboard of the terminal."""

    def notify(
        self,
        message: str,
        *,
        title: str = "",
        severity: SeverityLevel = "information",
        timeout: float | None = None,
        markup: bool = False,
    ) -> None:
        """Show a notification."""


def host_of(node: DOMNode) -> Host:
    """Return the app that shows `node`."""
    return cast("Host", node.app)
