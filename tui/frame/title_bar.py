"""The title: the screens, which one is in front, and what is running or stopped."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len, set_cell_size
from textual.content import Content
from textual.style import Style
from textual.widget import Widget

if TYPE_CHECKING:
    from textual.geometry import Size

NAME = " Deck "
HIGH = 30
"""A terminal of this many rows has two lines for the title all the time."""
SHARE = 3
"""Beside the tabs, the state takes one third of the line at most."""


class TitleBar(Widget):
    """Screens as tabs, which can be clicked; the state in words; an alarm on a line of its own.

    No name is abbreviated: every tab shows its key, the one in front its name, the others their
    names as far as there is room. With `HIGH` rows the state has the second line, which an alarm
    shares with it; with fewer it stands beside the tabs, and an alarm brings the second line.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "title-bar--name",
        "title-bar--tab",
        "title-bar--front",
        "title-bar--state",
        "title-bar--alarm",
        "title-bar--danger",
        "title-bar--stop",
    }
    DEFAULT_CSS = """
    TitleBar {
        height: auto;
        width: 1fr;
        background: $panel;
        color: $foreground;
        link-style: none;
        link-color: $foreground;
        link-background: transparent;
        link-style-hover: reverse;
        .title-bar--name { color: $accent; text-style: bold; }
        .title-bar--tab { color: $foreground; }
        .title-bar--front { color: $foreground; text-style: bold reverse; }
        .title-bar--state { color: $foreground; }
        .title-bar--alarm { color: #000000; background: #ffb000; text-style: bold; }
        .title-bar--danger { color: #ffffff; background: #b00020; text-style: bold; }
        .title-bar--stop { color: #ffffff; background: #b00020; text-style: bold; }
        &.-stop {
            background: #b00020;
            link-color: #ffffff;
            .title-bar--name { color: #ffffff; }
            .title-bar--tab, .title-bar--front { color: #ffffff; }
        }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._tabs: tuple[tuple[str, str, bool], ...] = ()
        self._states: tuple[str, ...] = ()
        self._alarms: tuple[str, ...] = ()
        self._look = "state"

    def show(
        self,
        tabs: Sequence[tuple[str, str, bool]],
        states: Sequence[str],
        alarms: Sequence[str] = (),
        look: str = "alarm",
    ) -> None:
        """Show tabs of (text, action, in front) and the first that fits of `states` and of `alarms`.

        Both go from long to short. `look` is how an alarm looks: `alarm`, `danger` or `stop`; with
        the last all lines are red.
        """
        shown = (tuple(tabs), tuple(states), tuple(alarms), look)
        before = (self._tabs, self._states, self._alarms, self._look)
        if shown != before:
            self._tabs, self._states, self._alarms, self._look = shown
            self.set_class(bool(alarms) and look == "stop", "-stop")
            self.refresh(layout=bool(shown[0]) != bool(before[0]) or bool(shown[2]) != bool(before[2]))

    @property
    def text(self) -> str:
        return self.render().plain

    def get_content_height(self, container: Size, viewport: Size, width: int) -> int:
        del container, viewport, width
        return 2 if self._alarms or self._is_high else 1

    @property
    def _is_high(self) -> bool:
        return bool(self._tabs) and self.app.size.height >= HIGH

    def render(self) -> Content:
        """Draw one line or two."""
        if self._is_high:
            return self._line(self._left(""), "").append("\n").append(self._second())
        state = self._state(self._room() // SHARE if self._tabs else self._room())
        first = self._line(self._left(state), state)
        return first.append("\n").append(self._line(self._alarm(), "")) if self._alarms else first

    def _second(self) -> Content:
        """Return the alarm and what it leaves room for of the state, or the state alone."""
        if not self._alarms:
            return self._line(self._said(self._state(self.size.width - 2), "state"), "")
        alarm = self._alarm()
        room = self.size.width - alarm.cell_length - 4
        return self._line(alarm, next((state for state in self._states if cell_len(state) <= room), ""))

    def _alarm(self) -> Content:
        room = self.size.width - 2
        fitting = (words for words in self._alarms if cell_len(words) <= room)
        return self._said(next(fitting, _cut(self._alarms[-1], room)), self._look)

    def _state(self, room: int) -> str:
        states = self._states or ("",)
        return next((state for state in states if cell_len(state) <= room), _cut(states[-1], room))

    def _line(self, left: Content, state: str) -> Content:
        if not state:
            return left
        gap = " " * max(0, self.size.width - left.cell_length - cell_len(state) - 2)
        return left.append(gap).append(self._said(state, "state"))

    def _said(self, words: str, look: str) -> Content:
        return Content.styled(f" {words} ", self.get_visual_style(f"title-bar--{look}"))

    def _room(self) -> int:
        """Return the cells beside the name of the program."""
        return self.size.width - cell_len(NAME) - 2

    def _left(self, state: str) -> Content:
        """Return the name of the program and the tabs, as they fit beside the state."""
        parts = [Content.styled(NAME, self.get_visual_style("title-bar--name"))]
        for text, action, front in self._fitting(self._room() - cell_len(state)):
            style = self.get_visual_style("title-bar--front" if front else "title-bar--tab")
            parts.append(Content.styled(f" {text} ", style + Style.from_meta({"@click": action})))
        return Content("").join(parts)

    def _fitting(self, room: int) -> Sequence[tuple[str, str, bool]]:
        """Return the tabs; whole names take the room that the keys leave, the one in front first."""
        tabs = [(text.partition(" ")[0], action, front) for text, action, front in self._tabs]
        room -= sum(cell_len(key) + 2 for key, *_more in tabs)
        whole = [(not front, cell_len(text), at) for at, (text, _action, front) in enumerate(self._tabs)]
        for _behind, cells, at in sorted(whole):
            room -= cells - cell_len(tabs[at][0])
            if room < 0:
                break
            tabs[at] = self._tabs[at]
        return tabs


def _cut(text: str, room: int) -> str:
    if cell_len(text) <= room:
        return text
    return set_cell_size(text, room - 1).rstrip() + "…" if room > 1 else ""
