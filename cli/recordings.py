"""Listing the recordings made by `deck record` and F6, and finding them by name."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from graph.bag.listing import bags_in
from launcher.errors import UsageError
from launcher.rundir import recordings_path
from text.i18n import _, localized
from text.output import BOLD, YELLOW, Paint, table, write
from text.plain import plain
from text.sentences import say
from text.suggestions import did_you_mean
from tui.recording.words import length_words, size_words

if TYPE_CHECKING:
    from graph.bag.listing import ListedBag


def list_recordings() -> int:
    """Show the recordings in the default folder, newest first."""
    folder = recordings_path()
    bags = bags_in(folder)
    if not bags:
        words = _("no recordings in {folder}: F6 on the screen or `deck record` makes one")
        write(words.format(folder=plain(str(folder))))
        return 0
    paint = Paint(sys.stdout)
    head = (_("NAME"), _("ENDED"), _("LENGTH"), _("TOPICS"), _("MESSAGES"), _("SIZE"))
    first, *rows = table(head, [_row(bag) for bag in bags])
    write(paint(first, BOLD))
    for row, bag in zip(rows, bags, strict=True):
        write(row)
        if bag.trouble:
            write(paint(f"  {localized(bag.trouble)}", YELLOW))
    write(_("recordings are in {folder}; to open one: deck replay NAME").format(folder=plain(str(folder))))
    return 0


def find_recording(named: str) -> Path:
    """Return the path of a recording, given by its path or by its name in the default folder.

    Raises:
        UsageError: if it is neither.
    """
    path, folder = Path(named), recordings_path()
    if path.exists() or len(path.parts) != 1:
        return path
    if (folder / named).exists():
        return folder / named
    names = [bag.name for bag in bags_in(folder)]
    longer = [name for name in names if name.startswith(named)][:1]
    near = did_you_mean(longer[0] if longer else named, names)
    raise UsageError(
        say(
            "{name}: there is no such file or folder here or in {folder}{near}; `deck replay` alone"
            " lists the recordings",
            name=named,
            folder=folder,
            near=say("; {hint}", hint=near) if near else "",
        )
    )


def _row(bag: ListedBag) -> tuple[str, ...]:
    ended = time.strftime("%Y-%m-%d %H:%M", time.localtime(bag.changed_s))
    return (
        plain(bag.name),
        ended,
        "–" if bag.seconds is None else length_words(bag.seconds),
        "–" if bag.topics is None else str(bag.topics),
        "–" if bag.messages is None else str(bag.messages),
        size_words(bag.bytes),
    )
