"""One line under the log: following or paused, how much is shown, and which filters apply."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from textual.content import Content
from textual.widget import Widget

from launcher.status import Severity
from text.i18n import _, ngettext
from text.plain import plain

if TYPE_CHECKING:
    from tui.log_view.view import LogView

LONGEST_NAME = 24


def grouped(count: int) -> str:
    """A number with blanks between thousands."""
    return f"{count:,}".replace(",", "\N{NO-BREAK SPACE}")


class LogBar(Widget):
    """Shows the state of a log view in words; what does not fit is left out from the end."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"log-bar--paused", "log-bar--chosen"}
    DEFAULT_CSS = """
    LogBar {
        height: 1;
        width: 1fr;
        background: $panel;
        color: $foreground 80%;
        .log-bar--paused { background: $warning; color: auto 90%; text-style: bold; }
        .log-bar--chosen { text-style: bold; }
    }
    """

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._parts: tuple[tuple[str, str], ...] = ()

    def show(self, view: LogView) -> None:
        """Show the state of `view`."""
        parts = tuple(state_parts(view))
        if parts != self._parts:
            self._parts = parts
            self.refresh()

    @property
    def words(self) -> str:
        """The full text, the most important parts first."""
        return " · ".join(text for text, _style in self._parts)

    def render(self) -> Content:
        """Draw as many parts as fit."""
        drawn: list[Content] = []
        room = self.size.width
        for text, style in self._parts:
            room -= cell_len(text) + 2
            if room < 0:
                break
            look = self.get_visual_style(f"log-bar--{style}") if style else ""
            drawn.append(Content.styled(f" {text} ", look))
        return Content("").join(drawn)


def state_parts(view: LogView) -> list[tuple[str, str]]:
    """(text, style) of each part: following, long name, search, lines, nodes, severity, counts."""
    return [*_tail_parts(view), *_search_parts(view), *_filter_parts(view), *_count_parts(view)]


def _tail_parts(view: LogView) -> list[tuple[str, str]]:
    if view.following:
        return [(_("▶ following"), "")]
    words = ngettext("‖ paused, {count} new", "‖ paused, {count} new", view.fresh)
    paused = (words.format(count=grouped(view.fresh)), "paused")
    return [paused, *_node_parts(view), (_("End follows"), "")]


def _node_parts(view: LogView) -> list[tuple[str, str]]:
    """The node of the line at the cursor, if its column has no room for the name."""
    node = view.choice.node
    return [(plain(node), "chosen")] if node is not None and view.cuts(node) else []


def _search_parts(view: LogView) -> list[tuple[str, str]]:
    chosen = view.log_filter
    if not chosen.search:
        return []
    found = len(view.index.found)
    text = plain(chosen.search, LONGEST_NAME)
    if not found:
        return [(_("“{text}” not found").format(text=text), "chosen")]
    number = view.choice.found_number
    count = f"{grouped(number)}/{grouped(found)}" if number else grouped(found)
    words = _("“{text}” {count}") if not chosen.only_found else _("only “{text}” {count}")
    return [(words.format(text=text, count=count), "chosen")]


def _filter_parts(view: LogView) -> list[tuple[str, str]]:
    chosen = view.log_filter
    parts: list[tuple[str, str]] = []
    if chosen.only is not None:
        name = plain(chosen.only, LONGEST_NAME)
        parts.append((_("only {node}").format(node=name), "chosen"))
    elif chosen.muted:
        count = len(chosen.muted)
        words = ngettext("{count} node muted", "{count} nodes muted", count)
        parts.append((words.format(count=count), "chosen"))
    if chosen.minimum is not Severity.DEBUG:
        words = view.minimum_words or _("{severity} and worse")
        parts.append((words.format(severity=chosen.minimum.name), "chosen"))
    return parts


def _count_parts(view: LogView) -> list[tuple[str, str]]:
    parts: list[tuple[str, str]] = []
    lines = len(view.choice.entries)
    if lines > 1:
        words = ngettext("{count} line selected", "{count} lines selected", lines)
        parts.append((words.format(count=grouped(lines)), "chosen"))
    shown, total = len(view.index.shown), len(view.ring.entries)
    words = ngettext("{count} line", "{count} lines", total)
    if shown != total:
        words = ngettext("{shown} of {count} line", "{shown} of {count} lines", total)
    parts.append((words.format(shown=grouped(shown), count=grouped(total)), ""))
    if not view.fold:
        parts.append((_("lines not wrapped"), ""))
    return parts
