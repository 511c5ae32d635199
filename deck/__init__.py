"""Deck as one package: the only name that it takes in site-packages when installed.

The rooms (cli, tui, launcher, graph, nodes, robot, text) import each other by their bare names. In
a checkout they are beside this folder, in a wheel inside it. Their location comes first on the path
of Deck's own processes, and of no others: importing `deck` loads this file and nothing else, and
another project's `graph` or `text` is not affected.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

_HERE = Path(__file__).resolve().parent
PLACE = str(_HERE if (_HERE / "cli").is_dir() else _HERE.parent)
"""The folder that the rooms are in."""


def enter() -> None:
    """Make this process look for modules in the folder of the rooms first."""
    sys.path[:] = [PLACE, *(place for place in sys.path if place != PLACE)]


def main() -> int:
    """Run the program `deck`; return the exit code."""
    enter()
    from cli.main import main

    return main()


if sys.argv[:1] == ["-m"]:
    # `python -m deck`, or `python -m deck.nodes.hello` in a wheel, is importing this package first.
    # It has put the current folder first on the path, which is not part of Deck.
    if sys.path[0] in ("", os.getcwd()):  # noqa: PTH109
        del sys.path[0]
    enter()
