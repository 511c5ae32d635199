"""The terminal: whether the screen can be drawn, and how well."""

from __future__ import annotations

import codecs
import locale
import os
import shutil
import sys
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from cli.doctor.finding import ok, warn
from text.i18n import _

if TYPE_CHECKING:
    from collections.abc import Mapping

    from cli.doctor.finding import Finding

LEAST = (80, 24)
VARIABLES = ("TERM", "COLORTERM", "NO_COLOR", "SSH_CONNECTION", "TMUX", "TERM_PROGRAM", "LANG")
TRUECOLOR_TERMS = ("-direct", "-truecolor", "kitty", "alacritty", "wezterm", "ghostty", "foot")
"""Words in the names of terminals that can show 16 million colours, even if Rich does not know."""


@dataclass(frozen=True)
class TerminalFacts:
    """What the terminal supports."""

    is_terminal: bool = True
    environ: Mapping[str, str] = field(default_factory=dict)
    encoding: str = "utf-8"
    columns: int = 120
    lines: int = 40


def collect() -> TerminalFacts:
    size = shutil.get_terminal_size(fallback=(0, 0))
    return TerminalFacts(
        is_terminal=sys.stdin.isatty() and sys.stdout.isatty(),
        environ={name: os.environ[name] for name in VARIABLES if name in os.environ},
        encoding=sys.stdout.encoding or locale.getpreferredencoding(do_setlocale=False),
        columns=size.columns,
        lines=size.lines,
    )


def diagnose(facts: TerminalFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    found = [_encoding(facts)]
    if not facts.is_terminal:
        return [ok("terminal", _("no terminal here: `deck run` works without one")), *found]
    return [_kind(facts), *found, _colour(facts), _size(facts)]


def _kind(facts: TerminalFacts) -> Finding:
    term = facts.environ.get("TERM", "")
    if term in ("", "dumb"):
        text = _("TERM={term}: no screen can be drawn").format(term=term)
        return warn("terminal", text, "export TERM=xterm-256color")
    return ok("terminal", _("terminal {term}").format(term=term))


def _encoding(facts: TerminalFacts) -> Finding:
    try:
        name = codecs.lookup(facts.encoding).name
    except LookupError:
        name = facts.encoding
    if name == "utf-8":
        return ok("terminal.encoding", "UTF-8")
    text = _("the encoding is {encoding}: pictures and Russian will be unreadable")
    return warn("terminal.encoding", text.format(encoding=name), "export LANG=C.UTF-8")


def _colour(facts: TerminalFacts) -> Finding:
    env = facts.environ
    term = env.get("TERM", "")
    if env.get("NO_COLOR"):
        fix = _("unset NO_COLOR if you want colours")
        return warn("terminal.colour", _("NO_COLOR is set: no colours"), fix)
    depth = _drawn_with(env)
    if depth == "truecolor":
        return ok("terminal.colour", _("16 million colours"))
    fix = _("if the terminal can, export COLORTERM=truecolor (SSH does not pass it on)")
    if depth == "256":
        return warn("terminal.colour", _("256 colours: pictures look coarse"), fix)
    if not any(word in term for word in TRUECOLOR_TERMS):
        fix = _("if the terminal can, export TERM=xterm-256color")
    return warn("terminal.colour", _("16 colours or fewer: hues are hard to tell apart"), fix)


def _drawn_with(env: Mapping[str, str]) -> str | None:
    """Return the colours that the screen will use; Rich decides, whatever the terminal supports."""
    from rich.console import Console

    return Console(force_terminal=True, _environ=env).color_system


def _size(facts: TerminalFacts) -> Finding:
    size = (facts.columns, facts.lines)
    text = _("{columns} columns, {lines} lines").format(columns=size[0], lines=size[1])
    if size[0] < LEAST[0] or size[1] < LEAST[1]:
        return warn("terminal.size", text, _("at least 80x24; 120x40 is comfortable"))
    return ok("terminal.size", text)
