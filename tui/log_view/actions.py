"""The actions of every screen whose `pane` is a log, each under an id that begins with the screen's name."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from text.i18n import N_
from tui.actions.action import Announce, always

if TYPE_CHECKING:
    from tui.log_view.pane import LogPane

Condition = Callable[[Any], "bool | None"]


class HasLog(Protocol):
    """A screen with a log."""

    @property
    def pane(self) -> LogPane: ...


action: Announce[HasLog] = Announce()


def _folder(id: str) -> str:
    """Return the module of actions of the screen that an id begins with."""
    return f"tui.{id.partition('.')[0]}.actions"


def pausing(id: str, when: Condition = always) -> None:

    @action(
        id,
        "p",
        N_("Pause"),
        N_("Pause while lines come in, or follow the newest again."),
        footer=True,
        anywhere=True,
        when=when,
        label=lambda screen: N_("Pause") if screen.pane.view.following else N_("Resume"),
        module=_folder(id),
    )
    def pause(screen: HasLog) -> None:
        view = screen.pane.view
        (view.pause if view.following else view.follow)()


def searching(room: str, when: Condition = always, *, footer: bool = False) -> None:
    """Announce the keys that search; `footer` says whether the footer shows the first of them."""

    @action(
        f"{room}.search",
        "slash,ctrl+f",
        N_("Search"),
        N_("Find text in the lines as you type; Escape ends it."),
        means="find",
        footer=footer,
        priority=True,
        anywhere=True,
        when=lambda screen: when(screen) and not screen.pane.prompt.kind,
        module=_folder(room),
    )
    def search(screen: HasLog) -> None:
        screen.pane.search()

    @action(
        f"{room}.next",
        "n",
        N_("Next"),
        N_("Go to the next line found."),
        means="next",
        when=when,
        module=_folder(room),
    )
    def find_next(screen: HasLog) -> None:
        screen.pane.find(1)

    said = N_("Go to the previous line found.")

    @action(f"{room}.previous", "N", N_("Previous"), said, means="previous", when=when, module=_folder(room))
    def find_previous(screen: HasLog) -> None:
        screen.pane.find(-1)


def folding(room: str, when: Condition = always) -> None:
    """Announce the key that wraps long lines."""

    @action(
        f"{room}.fold",
        "w",
        N_("Wrap"),
        N_("Wrap long lines, or show one row of each: left and right shift it."),
        footer=True,
        anywhere=True,
        when=when,
        module=_folder(room),
    )
    def fold(screen: HasLog) -> None:
        screen.pane.view.set_fold(not screen.pane.view.fold)


def taking(room: str, when: Condition = always) -> None:
    """Announce the keys that copy the selected lines and write them to a file."""

    @action(
        f"{room}.copy",
        "y",
        N_("Copy"),
        N_("Copy the selected lines to the clipboard of your terminal."),
        footer=True,
        when=when,
        module=_folder(room),
    )
    def copy(screen: HasLog) -> None:
        screen.pane.copy()

    @action(
        f"{room}.save",
        "W",
        N_("Write"),
        N_("Write the selected lines to a file, or all lines shown if none is selected."),
        means="write to a file",
        footer=True,
        when=when,
        module=_folder(room),
    )
    def save(screen: HasLog) -> None:
        screen.pane.save()
