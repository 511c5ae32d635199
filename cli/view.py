"""`deck view` and `deck foxglove`: the running robot in 3D, in a process of its own.

With `--json` it writes one object when it is open, and ends with its standard input:

    view    kind: window, page or foxglove; url, empty for a window; ports that a browser or
            Foxglove needs; ssh, what forwards them to the user's own machine, empty without SSH
"""

from __future__ import annotations

import os
import sys
import threading
import webbrowser
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from cli.commands import Parser, command
from cli.domains import running_domain
from cli.options import add_graph, port
from launcher.errors import LauncherError, UsageError
from launcher.processes.ending import stop_by_signals
from text.i18n import _
from text.output import json_text, keep_stdout_to_ourselves, write
from text.sentences import reason_of
from view.place import ViewError, has_window, need_foxglove, rerun_program, rviz_program, ssh_command

if TYPE_CHECKING:
    from view.sharing import Sharing
    from view.showing import Showing

RVIZ = Path("rviz") / "robot.rviz"
"""Among the profiles."""


def _view_options(parser: Parser) -> None:
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--web",
        action="store_true",
        help=_("a page for a browser, as over SSH; by default a window, where there is a display"),
    )
    where.add_argument("--rviz", action="store_true", help=_("RViz2 with the robot's settings, if it is installed"))
    parser.add_argument("--port", metavar="N", type=port, help=_("port of the page; by default 9090 or the next"))
    parser.add_argument("--no-open", dest="open", action="store_false", help=_("do not open the page in a browser"))
    _add_common(parser)
    parser.epilog = _(
        "Exit code: 0 if it was closed, 1 if it broke off, 2 if it could not start: the viewer is "
        "not installed, or the port is taken."
    )


def _add_common(parser: Parser) -> None:
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    parser.add_argument(
        "--json", action="store_true", help=_("print JSON, for programs, and end with standard input")
    )


@command("view", _view_options)
def view_command(options: Namespace) -> int:
    _name, domain, discovery = running_domain(options.domain, options.discovery)
    if options.rviz:
        _rviz(domain, discovery)
    from view.showing import Showing

    window = has_window(os.environ) and not options.web
    compact = bool(os.environ.get("SSH_CONNECTION"))
    with _viewer_faults():
        rerun_program()
        stop = _stopping(options)
        showing = Showing(domain, discovery, window=window, port=options.port, compact=compact)
    with showing:
        _tell("window" if window else "page", showing.url, showing.ports, domain, as_json=options.json)
        if showing.url and options.open and has_window(os.environ):
            webbrowser.open(showing.url)
        return _wait(showing, stop)


def _foxglove_options(parser: Parser) -> None:
    parser.add_argument("--port", metavar="N", type=port, help=_("port to serve at; by default 8765 or the next"))
    _add_common(parser)
    parser.epilog = _(
        "Exit code: 0 if it was stopped, 1 if it broke off, 2 if it could not start: the server "
        "is not installed, or the port is taken."
    )


@command("foxglove", _foxglove_options)
def foxglove_command(options: Namespace) -> int:
    _name, domain, discovery = running_domain(options.domain, options.discovery)
    from view.sharing import Sharing

    with _viewer_faults():
        need_foxglove()
        stop = _stopping(options)
        sharing = Sharing(domain, discovery, options.port)
    with sharing:
        _tell("foxglove", sharing.url, (sharing.port,), domain, as_json=options.json)
        return _wait(sharing, stop)


@contextmanager
def _viewer_faults() -> Iterator[None]:
    """Raise UsageError for what is not installed, or cannot be opened."""
    try:
        yield
    except ViewError as error:
        raise UsageError(reason_of(error)) from error


def _wait(viewer: Showing | Sharing, stop: threading.Event) -> int:
    try:
        viewer.wait(stop)
    except ViewError as error:
        raise LauncherError(reason_of(error)) from error
    return 0


def _stopping(options: Namespace) -> threading.Event:
    """Return what is set when it is to end: by a signal, or by the end of standard input."""
    stop = stop_by_signals()
    keep_stdout_to_ourselves()
    if options.json:
        threading.Thread(target=_until_input_ends, args=(stop,), daemon=True).start()
    return stop


def _until_input_ends(stop: threading.Event) -> None:
    # Not by sys.stdin, whose lock would be held when the interpreter ends.
    while os.read(0, 4096):
        pass
    stop.set()


def _tell(kind: str, url: str, ports: tuple[int, ...], domain: int, *, as_json: bool) -> None:
    ssh = ssh_command(ports, os.environ)
    if as_json:
        write(json_text({"event": "view", "kind": kind, "url": url, "ports": ports, "domain": domain, "ssh": ssh}))
        ssh = ""
    elif kind == "window":
        write(_("domain {domain} in a window of Rerun; close it or press Ctrl-C").format(domain=domain))
        ssh = ""
    elif kind == "foxglove":
        write(_("domain {domain} for Foxglove: {url}; Ctrl-C ends it").format(domain=domain, url=url))
    else:
        write(_("domain {domain} in a browser: {url}; Ctrl-C ends it").format(domain=domain, url=url))
    if ssh:
        write(_("first, on the machine in front of you: {command}").format(command=ssh))
    sys.stdout.flush()


def _rviz(domain: int, discovery: str | tuple[str, ...]) -> NoReturn:
    from cli.shell import environment_in
    from launcher.profile.defaults import SHIPPED

    with _viewer_faults():
        program = rviz_program()
    sys.stdout.flush()
    os.execve(program, [program, "-d", str(SHIPPED / RVIZ)], environment_in(domain, discovery))
