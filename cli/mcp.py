"""`deck mcp`: the robot for agents that speak the Model Context Protocol, and its safeguards."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING

from cli.commands import command
from cli.options import add_graph, add_running, port
from launcher.processes.ending import ENDING
from launcher.processes.interrupts import run
from text.i18n import _
from text.output import say_error, write
from text.plain import plain

if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Callable, Coroutine

    from agents.server import AgentServer
    from cli.commands import Parser


class _PlainHandler(logging.Handler):
    """Writes to standard error what is safe to write there."""

    def emit(self, record: logging.LogRecord) -> None:
        say_error(f"deck mcp: {plain(record.getMessage(), 500)}")


MCP_PORT = 8730
"""Where agents find `deck mcp --http`. Not that of Foxglove, which may be served beside it."""


def _mcp_options(parser: Parser) -> None:
    add_running(parser)
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    parser.add_argument(
        "--approve",
        choices=("never", "ask", "always"),
        default="ask",
        help=_("whether agents drive: never, after the person at the screen is asked (the default), or always"),
    )
    parser.add_argument(
        "--http", action="store_true", help=_("serve agents on this machine by HTTP, not the one that has started it")
    )
    parser.add_argument(
        "--port",
        metavar="N",
        type=port,
        default=MCP_PORT,
        help=_("with --http: the port, {port} by default; 0 takes a free one").format(port=MCP_PORT),
    )
    parser.add_argument(
        "--show-token", action="store_true", help=_("show the token that agents need for --http, and end")
    )
    parser.epilog = _(
        "Limits of speed and distance are in the profile, and no approval lifts them. The agent "
        "finds the robot whenever it runs. Exit code: 0, or 2 if it could not start."
    )


@command("mcp", _mcp_options)
def mcp_command(options: Namespace) -> int:
    """Serve agents until the agent, or a signal, ends it."""
    if find_spec("mcp") is None:
        say_error(_("{package} is not installed").format(package="mcp"))
        say_error(_("pip install {install}").format(install="'deck-robot[agents]'"))
        return 2
    if options.show_token:
        from agents.http import own_token

        write(own_token())
        return 0
    if not options.http and sys.stdin.isatty():
        say_error(
            _(
                "deck mcp is started by an agent, which speaks to it on standard input; "
                "`--http` serves agents that run already"
            )
        )
        return 2
    return _http(options) if options.http else _stdio(options)


def _stdio(options: Namespace) -> int:
    # Before anything is imported that might write.
    from agents.stdio import serve_stdio, take_standard_streams

    source, sink = take_standard_streams()
    _run(lambda server: serve_stdio(server, source, sink), options)
    return 0


def _http(options: Namespace) -> int:
    from agents.http import address_of, listen, own_token, serve_http

    token = own_token()
    listening = listen(options.port)
    said = _("{address} serves agents that have the token, see `deck mcp --show-token`")
    say_error(said.format(address=address_of(listening)))
    with contextlib.suppress(OSError):
        # What libraries write must not be taken for an answer.
        os.dup2(2, 1)
    with listening:
        _run(lambda server: serve_http(server, listening, token), options)
    return 0


def _server(options: Namespace) -> AgentServer:
    from agents.server import AgentServer
    from launcher.consent import Approval

    # Requests are written into warnings, and may be anything.
    logging.basicConfig(handlers=[_PlainHandler()], level=logging.WARNING)
    return AgentServer(Approval(options.approve), options.name, options.domain, options.discovery)


def _run(serving: Callable[[AgentServer], Coroutine[object, object, None]], options: Namespace) -> None:
    async def until_signal() -> None:
        task, loop = asyncio.current_task(), asyncio.get_running_loop()
        assert task is not None
        for number in ENDING:
            loop.add_signal_handler(number, task.cancel)
        with contextlib.suppress(asyncio.CancelledError):
            await serving(_server(options))

    run(until_signal())
