"""Deck as one package: the only name that an installed one takes in site-packages.

The rooms (cli, tui, launcher, graph, nodes, robot, text) import each other by their bare names. In
a checkout they lie beside this folder, in a wheel inside it. Their place goes first on the path of
Deck's own processes, and of no others: who imports `deck` gets this file and nothing more, and
somebody else's `graph` or `text` stays what it is.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

_HERE = Path(__file__).resolve().parent
PLACE = str(_HERE if (_HERE / "cli").is_dir() else _HERE.parent)
"""The folder that the rooms are in."""


def enter() -> None:
    """Have this process look for modules in the place of the rooms before all others."""
    sys.path[:] = [PLACE, *(place for place in sys.path if place != PLACE)]


def main() -> int:
    """Be the program `deck`; return what to exit with."""
    enter()
    from cli.main import main

    return main()


if sys.argv[:1] == ["-m"]:
    # `python -m deck`, or `python -m deck.nodes.hello` in a wheel, is importing this on its way.
    # It has put the current folder first, and what lies there is no part of Deck.
    if sys.path[0] in ("", os.getcwd()):  # noqa: PTH109
        del sys.path[0]
    enter()
