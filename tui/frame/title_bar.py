"""The top line: the screens, which one is in front, and what is running or stopped."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, NamedTuple

from rich.cells import cell_len, set_cell_size
from textual.content import Content
from textual.style import Style
from textual.widget import Widget

NAME = " Deck "
URGENT = ("danger", "stop")
ENOUGH = 16
"""Cells of an alarm that are enough; its full text would hide the names of the tabs."""
SHORT, SHORTEST = 3, 2
"""Letters of a tab's name if there is little room, and if there is less."""
NAMED = 5
"""This many of the levels show a part of each name."""


class _Level(NamedTuple):
    """Tabs of (text, action, in front), shortened to a certain degree."""

    tabs: Sequence[tuple[str, str, bool]]
    gap: int
    """Blanks between two tabs."""
    program: str = NAME
    """The name of the program, or nothing."""

    @property
    def width(self) -> int:
        """Cells of all tabs and of what is before them."""
        tabs = sum(cell_len(text) + self.gap for text, *_more in self.tabs)
        return cell_len(self.program) + tabs + (self.gap == 1)


class TitleBar(Widget):
    """Screens as tabs on the left, which can be clicked; on the right the state in words."""

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
        height: 1;
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
        self._look = "state"
        self._aside = ""

    def show(
        self, tabs: Sequence[tuple[str, str, bool]], states: Sequence[str], look: str = "state", aside: str = ""
    ) -> None:
        """Show tabs of (text, action, in front), and on the right the first of `states` that fits.

        `look` is `state`, `alarm`, `danger` or `stop`; with the last the whole line is red. The
        texts of the last two take precedence over the tabs. Otherwise, tabs that are not in front
        are shortened before the state is: to a few letters, then moved together, then to two
        letters without the name of the program, then to their keys; where room is left, the names
        that lack the fewest letters are whole again. `aside` follows the state if there is room for
        it beside tabs with a few letters each, or beside all tabs that the state leaves.
        """
        shown = (tuple(tabs), tuple(states), look, aside)
        if shown != (self._tabs, self._states, self._look, self._aside):
            self._tabs, self._states, self._look, self._aside = shown
            self.set_class(look == "stop", "-stop")
            self.refresh()

    @property
    def text(self) -> str:
        return self.render().plain

    def render(self) -> Content:
        """Draw the tabs, then as much of the state as fits."""
        level, state = self._with_aside(*self._fitting())
        left = self._left(self._completed(level, self._room() - level.width - cell_len(state)))
        gap = " " * max(0, self.size.width - left.cell_length - cell_len(state) - 2)
        style = self.get_visual_style(f"title-bar--{self._look}")
        return left.append(gap).append(Content.styled(f" {state} ", style))

    def _fitting(self) -> tuple[_Level, str]:
        """Return the tabs to show, and the longest state that fits beside them.

        The shortest state is too brief to justify keeping the tabs long: they are shortened first.
        If the state is urgent, its text comes first, and all tabs may disappear. The text of an
        alarm comes from a node and may be of any length: it is cut before the tabs lose their
        names.
        """
        alone, levels = self._room(), self._levels()
        named = levels[NAMED - 1]
        states = self._states or ("",)
        for state in states if self._look in URGENT else ():
            for level in (*levels, _Level((), 2)):
                if cell_len(state) <= alone - level.width:
                    return level, state
        for level in levels:
            spared = states[-1:] if len(states) > 1 and level in levels[:NAMED] else ()
            for state in states:
                if state not in spared and cell_len(state) <= alone - level.width:
                    return level, state
            room = alone - level.width
            if self._look == "alarm" and level is named and room >= ENOUGH:
                return level, _cut(states[-1], room)
        return levels[-1], _cut(states[-1], alone - levels[-1].width)

    def _with_aside(self, level: _Level, state: str) -> tuple[_Level, str]:
        """Return both, with `aside` appended if no tab loses its name or disappears for that."""
        if not self._aside:
            return level, state
        told, named = f"{state} · {self._aside}", self._levels()[:NAMED]
        for other in named if level in named else [level]:
            if other.width <= level.width and cell_len(told) <= self._room() - other.width:
                return other, told
        return level, state

    def _completed(self, level: _Level, spare: int) -> _Level:
        """Return the tabs with as many whole names as `spare` cells allow: `Deck` for `Dec`."""
        tabs = list(level.tabs)
        lacking = [
            (cell_len(whole[0]) - cell_len(cut[0]), at)
            for at, (whole, cut) in enumerate(zip(self._tabs, tabs, strict=False))
            if cut[0] != whole[0] and " " in cut[0]
        ]
        for cells, at in sorted(lacking):
            if cells <= spare:
                tabs[at] = self._tabs[at]
                spare -= cells
        return level._replace(tabs=tabs)

    def _room(self) -> int:
        """Return the cells for tabs and state."""
        return self.size.width - 3

    def _levels(self) -> list[_Level]:
        """Return all tabs, shorter and shorter; the first NAMED levels show a part of each name."""
        shapes = ((None, "", 2), (SHORT, ".", 2), (SHORT, ".", 1), (SHORT, "", 1))
        named = [_Level(_shortened(self._tabs, letters, mark), gap) for letters, mark, gap in shapes]
        # The name of a tab is worth more than that of the program.
        named.append(_Level(_shortened(self._tabs, SHORTEST), 1, ""))
        keys = _keys(self._tabs)
        return [*named, _Level(_shortened(self._tabs, 0), 2), _Level(keys, 2), _Level(keys, 1)]

    def _left(self, level: _Level) -> Content:
        parts = [Content.styled(level.program, self.get_visual_style("title-bar--name"))]
        for text, action, front in level.tabs:
            style = self.get_visual_style("title-bar--front" if front else "title-bar--tab")
            click = Style.from_meta({"@click": action})
            said = f" {text} " if level.gap > 1 else text
            parts += [Content(" " * (2 - level.gap)), Content.styled(said, style + click)]
        return Content("").join([*parts, Content(" " * (2 - level.gap))])


def _shortened(
    tabs: Sequence[tuple[str, str, bool]], letters: int | None, mark: str = ""
) -> Sequence[tuple[str, str, bool]]:
    """Shorten all tabs but the one in front; their keys stay. With None nothing is shortened.

    `mark` follows what was shortened.
    """
    if letters is None:
        return tabs
    return [(text if front else _initials(text, letters, mark), action, front) for text, action, front in tabs]


def _keys(tabs: Sequence[tuple[str, str, bool]]) -> Sequence[tuple[str, str, bool]]:
    return [(_initials(text, 0), action, front) for text, action, front in tabs]


def _initials(text: str, letters: int, mark: str = "") -> str:
    key, _blank, word = text.partition(" ")
    if letters and len(word) > letters + len(mark):
        word = f"{word[:letters]}{mark}"
    return f"{key} {word}" if letters else key


def _cut(text: str, room: int) -> str:
    if cell_len(text) <= room:
        return text
    return set_cell_size(text, room - 1).rstrip() + "…" if room > 1 else ""
