"""One line under the log: following or paused, how much is shown, and which filters apply."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from textual.content import Content
from textual.widget import Widget

from launcher.status import Severity
from text.i18n import _, ngettext
from text.plain import plain
from tui.log_view.rows import grouped

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tui.log_view.view import LogView

LONGEST_NAME = 24


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
    parts = [(_("▶ following"), "")]
    if not view.following:
        words = ngettext("‖ paused, {count} new", "‖ paused, {count} new", view.fresh)
        parts = [(words.format(count=grouped(view.fresh)), "paused")]
        node = view.choice.node
        # The column of nodes may have no room for the name.
        parts += [(plain(node), "chosen")] if node is not None and view.cuts(node) else []
        parts.append((_("End follows"), ""))
    chosen = [*_search_words(view), *_filter_words(view)]
    lines = len(view.choice.entries)
    if lines > 1:
        words = ngettext("{count} line selected", "{count} lines selected", lines)
        chosen.append(words.format(count=grouped(lines)))
    parts += [(words, "chosen") for words in chosen]
    shown, total = len(view.index.shown), len(view.ring.entries)
    words = ngettext("{count} line", "{count} lines", total)
    if shown != total:
        words = ngettext("{shown} of {count} line", "{shown} of {count} lines", total)
    parts.append((words.format(shown=grouped(shown), count=grouped(total)), ""))
    return parts if view.fold else [*parts, (_("lines not wrapped"), "")]


def _search_words(view: LogView) -> Iterator[str]:
    chosen, found = view.log_filter, len(view.index.found)
    text = plain(chosen.search, LONGEST_NAME)
    if text and not found:
        yield _("“{text}” not found").format(text=text)
    elif text:
        number = view.choice.found_number
        count = f"{grouped(number)}/{grouped(found)}" if number else grouped(found)
        words = _("“{text}” {count}") if not chosen.only_found else _("only “{text}” {count}")
        yield words.format(text=text, count=count)


def _filter_words(view: LogView) -> Iterator[str]:
    chosen = view.log_filter
    if chosen.only is not None:
        yield _("only {node}").format(node=plain(chosen.only, LONGEST_NAME))
    elif chosen.muted:
        count = len(chosen.muted)
        yield ngettext("{count} node muted", "{count} nodes muted", count).format(count=count)
    if chosen.minimum is not Severity.DEBUG:
        words = view.minimum_words or _("{severity} and worse")
        yield words.format(severity=chosen.minimum.name)
