"""Which viewers are installed, and how to get those that are not."""

from __future__ import annotations

import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

from text.sentences import Words, say
from view.faults import ViewError

OLDEST = (3, 11)
"""The first Python that Rerun's wheels are made for."""
CHECKOUT = Path(__file__).resolve().parent.parent / "Makefile"
"""Exists where Deck runs from its sources."""


def how_to_install() -> str:
    """Return the command that installs both viewers here."""
    if CHECKOUT.is_file():
        return "make view"
    return f"{sys.executable} -m pip install 'deck-robot[view]'"


def rerun_program() -> Path:
    """Return the viewer's program, which its wheel has inside.

    Raises ViewError if it is not installed.
    """
    found = find_spec("rerun_cli")
    if found is not None and found.origin is not None and find_spec("rerun") is not None:
        return Path(found.origin).with_name("rerun")
    raise ViewError(_without_rerun())


def _without_rerun() -> Words:
    if sys.version_info < OLDEST:
        return say("Rerun needs Python 3.11 or newer, and this is {version}", version=_version())
    return say("Rerun is not installed; to install it: {command}", command=how_to_install())


def _version() -> str:
    return ".".join(map(str, sys.version_info[:2]))


def need_foxglove() -> None:
    """Raise ViewError if the server for Foxglove is not installed."""
    if find_spec("foxglove") is None:
        raise ViewError(
            say("The server for Foxglove is not installed; to install it: {command}", command=how_to_install())
        )


def rviz_program() -> str:
    """Return where RViz2 is. Raises ViewError if it is nowhere on the PATH."""
    found = shutil.which("rviz2")
    if found is None:
        raise ViewError(
            say(
                "rviz2 is not on the PATH: source a ROS that has it, or leave out --rviz and take"
                " the viewer that needs none"
            )
        )
    return found
