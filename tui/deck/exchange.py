"""Exchanging a node that runs for a file of the learner's own, and back."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from course.folder.programs import programs_for
from launcher.errors import LauncherError
from launcher.profile.defaults import shown
from text.i18n import _, localized
from text.os_words import os_reason
from text.plain import plain
from text.sentences import reason_of
from tui.dialogs.choice import ChoiceScreen

if TYPE_CHECKING:
    from launcher.status import NodeStatus
    from tui.frame.screen import DeckScreen

LONGEST = 60


async def exchange_node(screen: DeckScreen, node: NodeStatus) -> None:
    """Run another program in the node's place, after asking which one if there are several."""
    link = screen.feed.link
    if link is None:
        return
    try:
        programs = await asyncio.to_thread(programs_for, link.session, node)
        if not programs:
            _tell(screen, _nothing(node))
            return
        program = programs[0]
        if len(programs) > 1:
            program = await _asked(screen, node, [one for one in programs if isinstance(one, Path)])
            if program is None:
                return
        await link.exchange(node.name, program)
    except LauncherError as error:
        _tell(screen, localized(reason_of(error)))
    except OSError as error:
        _tell(screen, localized(os_reason(error)))


async def _asked(screen: DeckScreen, node: NodeStatus, files: list[Path]) -> Path | None:
    def title() -> str:
        return _("Your own {node}").format(node=node.name)

    def words() -> str:
        return _("You have several files for this node. Which one is to run?")

    choices = {str(file): plain(shown(file)) for file in files}
    answer = await screen.app.push_screen_wait(ChoiceScreen(title, words, choices))
    return Path(answer) if answer else None


def _nothing(node: NodeStatus) -> str:
    """Return why there is nothing to exchange it for."""
    name = plain(node.name, LONGEST)
    if node.file:
        return _("Deck has no node {name} of its own.").format(name=name)
    words = _("You have no file for {name} yet: `deck new --node {name}` makes one.")
    return words.format(name=name)


def _tell(screen: DeckScreen, words: str) -> None:
    screen.notify(plain(words), severity="warning", markup=False)
