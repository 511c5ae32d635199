"""The learner's file in their own editor: the screen steps aside until the editor is closed."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from textual.app import SuspendNotSupported

from text.i18n import _, localized
from text.os_words import os_reason
from text.plain import plain
from tui.dialogs.choice import ChoiceScreen
from tui.frame.host import host_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from textual.screen import Screen

    from launcher.status import NodeStatus

OFFERED = ("nano", "micro", "vim", "nvim", "vi", "emacs", "hx", "kak", "joe", "mcedit", "code", "codium")
"""Offered where the user has named none, if they are installed."""
AT_LINE = frozenset({"vi", "vim", "nvim", "nano", "emacs", "emacsclient", "micro", "kak", "joe"})
"""Editors that take `+LINE` before the file."""
GOTO = frozenset({"code", "codium", "cursor"})
COLON = frozenset({"hx", "helix", "subl", "zed"})
"""Editors that take `file:line`."""


def editor(environ: Mapping[str, str], kept: str = "") -> list[str]:
    """Return the command of the user's editor, else of the one `kept`; empty if there is none."""
    chosen = environ.get("VISUAL") or environ.get("EDITOR") or kept
    try:
        return shlex.split(chosen)
    except ValueError:
        return chosen.split()


def installed_editors() -> list[str]:
    """Return the known editors that are installed."""
    found = [name for name in OFFERED if shutil.which(name)]
    # On most machines they are one program.
    return [name for name in found if name != "vi" or "vim" not in found]


def editor_command(command: Sequence[str], file: Path, line: int) -> list[str]:
    """Return the command that opens a file at a line; 0 for no line."""
    name = PurePath(command[0]).name
    if name in GOTO:
        where = [f"{file}:{line}"] if line else [str(file)]
        return [*command, *([] if "--wait" in command else ["--wait"]), "-g", *where]
    if not line:
        return [*command, str(file)]
    if name in COLON:
        return [*command, f"{file}:{line}"]
    return [*command, *([f"+{line}"] if name in AT_LINE else []), str(file)]


def edit_node(screen: Screen[None], node: NodeStatus) -> None:
    """Open the node's own file in the user's editor, at the line of its mistake if it has one."""
    fault = node.fault
    if fault is not None and fault.line:
        edit_file(screen, Path(fault.file), fault.line)
    else:
        edit_file(screen, Path(node.file))


def edit_file(screen: Screen[None], file: Path, line: int = 0) -> None:
    """Open a file in the user's editor, after asking which if none is known."""
    command = editor(os.environ, host_of(screen).editor)
    if command:
        _edit(screen, command, file, line)
    else:
        screen.run_worker(_choose(screen, file, line), exclusive=True, group="editor")


async def _choose(screen: Screen[None], file: Path, line: int) -> None:
    """Ask once which editor to use, keep the answer, and open the file in it."""
    host, names = host_of(screen), installed_editors()
    if not names:
        host.notify(
            _("No editor found: set EDITOR, as in export EDITOR=nano, and start Deck again."), severity="warning"
        )
        return
    answer = await screen.app.push_screen_wait(
        ChoiceScreen(lambda: _("Your editor"), _which_editor, dict(zip(names, names, strict=True)))
    )
    if answer:
        host.use_editor(answer)
        _edit(screen, [answer], file, line)


def _which_editor() -> str:
    return _(
        "Which program shall open your files? The answer is kept in settings.json; EDITOR, where "
        "it is set, comes first."
    )


def _edit(screen: Screen[None], command: Sequence[str], file: Path, line: int) -> None:
    """Give the terminal to the editor, and come back when it is closed."""
    host = host_of(screen)
    try:
        with screen.app.suspend():
            # What the screen prints is caught; the editor needs the terminal itself.
            terminal = host.terminal_fd
            subprocess.run(editor_command(command, file, line), stdout=terminal, stderr=terminal, check=False)
    except SuspendNotSupported:
        host.notify(_("This terminal has no room for an editor."), severity="warning")
    except OSError as error:
        words = _("{editor} could not be started: {reason}")
        reason = localized(os_reason(error))
        host.notify(plain(words.format(editor=command[0], reason=reason)), severity="error")
    host.redraw()
