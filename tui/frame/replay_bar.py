"""The position in a recording: one line above the keys, of which every part can be clicked."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content
from textual.style import Style
from textual.widget import Widget

from text.i18n import _, decimal
from tui.frame.actions.replay import back, faster_replay, forward, loop, slower_replay, step
from tui.frame.host import host_of
from tui.recording.words import length_words

if TYPE_CHECKING:
    from collections.abc import Iterator

    from textual.events import Click, MouseMove

    from graph.replay.player import ReplayState
    from graph.replay.replay import Replay

LOOK_S = 0.25
"""How often the bar checks the position in the recording."""
LEAST_TRACK = 10
TRACK = 24
"""Minimum width of the track before keys are shown."""


class ReplayBar(Widget):
    """`▶ 0:12 ━━━━●──────── 1:03  ×1`, and the keys where there is room."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "replay-bar--done",
        "replay-bar--rest",
        "replay-bar--words",
        "replay-bar--key",
        "replay-bar--warn",
    }
    DEFAULT_CSS = """
    ReplayBar {
        height: 1;
        width: 1fr;
        display: none;
        background: $panel;
        color: $foreground;
        link-style: none;
        link-color: $foreground;
        link-background: transparent;
        link-style-hover: reverse;
        .replay-bar--done { color: $accent; text-style: bold; }
        .replay-bar--rest { color: $foreground 40%; }
        .replay-bar--words { color: $foreground; }
        .replay-bar--key { color: $footer-key-foreground; text-style: bold; }
        .replay-bar--warn { color: $text-warning; text-style: bold; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._replay: Replay | None = None
        self._state: ReplayState | None = None
        self.track = (0, 0)
        """The column where it begins, and its width."""

    def on_mount(self) -> None:
        """Check the position in the recording regularly."""
        self._timer = self.set_interval(LOOK_S, self.look, pause=True)

    def show(self, replay: Replay | None) -> None:
        self._replay = replay
        self.display = replay is not None
        if replay is None:
            self._timer.pause()
        else:
            self._timer.resume()
            self.look()

    def look(self) -> None:
        """Redraw if anything has changed."""
        if self._replay is None or not self.screen.is_current:
            return
        state = self._replay.state
        if state != self._state:
            paused_before = self._state is not None and self._state.paused
            self._state = state
            self.refresh()
            if state.damage:
                host_of(self).sessions.tell_damage(state.damage)
            if state.paused != paused_before:
                self.screen.refresh_bindings()

    def on_click(self, event: Click) -> None:
        begin, width = self.track
        state = self._state
        if self._replay is not None and state is not None and begin <= event.x < begin + width:
            share = (event.x - begin) / max(1, width - 1)
            self._replay.seek(share * state.length_s)
            self.look()

    def on_mouse_move(self, event: MouseMove) -> None:
        """Show the time under the pointer."""
        begin, width = self.track
        state = self._state
        self.tooltip = None
        if state is not None and begin <= event.x < begin + width:
            share = (event.x - begin) / max(1, width - 1)
            self.tooltip = length_words(share * state.length_s)

    def render(self) -> Content:
        """Draw sign, position, track, length and rate; keys as far as there is room."""
        state = self._state
        if state is None:
            return Content("")
        left = self._left(state)
        right = self._right(state)
        room = self.size.width - left.cell_length - right.cell_length
        keys = Content("")
        for key in self._keys():
            if room - keys.cell_length - key.cell_length <= TRACK:
                break
            keys = keys.append(key)
        self.track = (left.cell_length, max(LEAST_TRACK, room - keys.cell_length - 1))
        return Content("").join([left, self._drawn_track(state), right, keys])

    def _left(self, state: ReplayState) -> Content:
        sign = "‖" if state.paused else "▶"
        words = self.get_visual_style("replay-bar--words")
        click = Style.from_meta({"@click": "app.act('replay.toggle')"})
        return Content.assemble((f" {sign} {_clock(state.position_s, state.length_s)} ", words + click))

    def _right(self, state: ReplayState) -> Content:
        words = self.get_visual_style("replay-bar--words")
        faster = Style.from_meta({"@click": "app.act('replay.faster')"})
        loop = Style.from_meta({"@click": "app.act('replay.loop')"})
        parts = [
            (f" {_clock(state.length_s, state.length_s)} ", words),
            (" ×" + decimal(f"{state.rate:g}") + " ", words + faster),
        ]
        if state.loop:
            parts.append((" ↻ ", words + loop))
        warning = self.get_visual_style("replay-bar--warn")
        if state.error:
            parts.append((" " + _("⚠ cannot be played any further") + " ", warning))
        elif state.damage:
            parts.append((" " + _("⚠ damaged") + " ", warning))
        elif state.is_cut:
            parts.append((" " + _("⚠ cut short") + " ", warning))
        elif state.is_incomplete:
            parts.append((" " + _("⚠ incomplete") + " ", warning))
        return Content.assemble(*parts)

    def _drawn_track(self, state: ReplayState) -> Content:
        _begin, width = self.track
        share = state.position_s / state.length_s if state.length_s else 1.0
        at = min(width - 1, round(share * (width - 1)))
        done = self.get_visual_style("replay-bar--done")
        rest = self.get_visual_style("replay-bar--rest")
        return Content.assemble(("━" * at + "●", done), ("─" * (width - 1 - at), rest))

    def _keys(self) -> Iterator[Content]:
        """Yield the keys that the footer does not show, the most useful first."""
        app = host_of(self)
        words = self.get_visual_style("replay-bar--words")
        bold = self.get_visual_style("replay-bar--key")
        for action in (step, back, forward, slower_replay, faster_replay, loop):
            click = Style.from_meta({"@click": f"app.act({action.id!r})"})
            key = app.keys_of(action)[0]
            yield Content.assemble((f"  {key}", bold + click), (f" {_(action.title)}", words + click))


def _clock(seconds: float, length_s: float) -> str:
    """Return a time with tenths, padded to the width of the length of the recording."""
    return decimal(f"{seconds:.1f}") if length_s < 60 else length_words(seconds)
