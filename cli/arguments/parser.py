"""The parser of every command: argparse in the language of the screen."""

from __future__ import annotations

import argparse
from typing import IO, NoReturn

from text.i18n import N_, _, ngettext
from text.output import harmless


class Parser(argparse.ArgumentParser):
    """A parser that uses the language of the screen and refers to the help."""

    def _print_message(self, message: str, file: IO[str] | None = None) -> None:  # type: ignore[override]
        """Never echo arguments unescaped: they may have been pasted."""
        super()._print_message(harmless(message), file)

    def error(self, message: str) -> NoReturn:
        """Exit with 2 after saying what is wrong and where the help is."""
        self.exit(2, f"{self.prog}: {message}\n" + _("for help: {prog} --help").format(prog=self.prog) + "\n")


ARGPARSE = (
    N_("usage: "),
    N_("positional arguments"),
    N_("options"),
    N_("optional arguments"),
    N_("show this help message and exit"),
    N_("the following arguments are required: %s"),
    N_("unrecognized arguments: %s"),
    N_("argument %(argument_name)s: %(message)s"),
    N_("invalid choice: %(value)r (choose from %(choices)s)"),
    N_("invalid choice: %(value)s (choose from %(choices)s)"),
    N_("expected one argument"),
    N_("ambiguous option: %(option)s could match %(matches)s"),
    N_("ignored explicit argument %r"),
)
"""The messages of argparse in Python 3.10 to 3.13, marked for the catalogue."""


def speak() -> None:
    """Make argparse look up its messages in our catalogue."""
    argparse._ = _  # type: ignore[attr-defined]
    argparse.ngettext = ngettext  # type: ignore[attr-defined]
