"""Where a viewer opens, and whether there is one: a window of this machine, or a page for a browser far away."""

from __future__ import annotations

import errno
import getpass
import shutil
import socket
import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Mapping

HERE = "127.0.0.1"
"""Everything is bound to it: nobody on the network can look."""
DATA_PORT, PAGE_PORT = 9876, 9090
"""Rerun's own: what the viewer reads from, and the page."""
FOXGLOVE_PORT = 8765
SCREENS = ("WAYLAND_DISPLAY", "DISPLAY")
TRIED = 50
"""Ports after the usual one, before the kernel chooses."""


class ViewError(Exception):
    """Why there is no viewer; its text is a sentence for the user, with the fix."""


class PortTakenError(ViewError):
    """Another program listens at the port that was asked for."""

    def __init__(self, port: int) -> None:
        super().__init__(say("port {port} is taken: choose another one with --port, or none", port=port))


@dataclass(frozen=True)
class Place:
    """The ports of a page, and how to get to it."""

    data_port: int
    page_port: int

    @property
    def source(self) -> str:
        """Where a viewer reads from, in Rerun's own notation."""
        return f"rerun+http://{HERE}:{self.data_port}/proxy"

    @property
    def url(self) -> str:
        return f"http://{HERE}:{self.page_port}"

    @property
    def query(self) -> str:
        return f"url={quote(self.source, safe='')}&hide_welcome_screen&persist=false"


def has_window(environ: Mapping[str, str]) -> bool:
    """Return whether a window would open before the user's eyes."""
    return not environ.get("SSH_CONNECTION") and any(environ.get(name) for name in SCREENS)


def ssh_command(ports: tuple[int, ...], environ: Mapping[str, str]) -> str:
    """Return what to run on the user's own machine to reach these ports; empty without SSH.

    The address is the one by which the user has reached this machine. Source: sshd(8), ENVIRONMENT.
    """
    words = environ.get("SSH_CONNECTION", "").split()
    if len(words) != 4:
        return ""
    address, port = words[2:]
    forwarded = " ".join(f"-L {each}:{HERE}:{each}" for each in ports)
    other_port = "" if port == "22" else f" -p {port}"
    return f"ssh -N {forwarded}{other_port} {getpass.getuser()}@{address}"


def free_port(usual: int, asked: int | None = None) -> int:
    """Return a port of this machine at which nobody listens: `asked`, or one near the usual.

    Raises PortTakenError if `asked` is taken.
    """
    if asked:
        if not is_free(asked):
            raise PortTakenError(asked)
        return asked
    near = (port for port in range(usual, usual + TRIED) if is_free(port))
    return next(near, None) or _any_port()


def is_free(port: int) -> bool:
    """Return whether nobody listens at this port."""
    with socket.socket() as one:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            one.bind((HERE, port))
        except OSError as error:
            if error.errno in (errno.EADDRINUSE, errno.EACCES):
                return False
            raise
        return True


def _any_port() -> int:
    with socket.socket() as one:
        one.bind((HERE, 0))
        port: int = one.getsockname()[1]
        return port


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
