"""`deck up`, `ps`, `logs` and `down`: profiles that run without a terminal."""

from __future__ import annotations

import asyncio
import sys
from argparse import Namespace

from cli.commands import Parser, command
from cli.domains import profile_to_run, stop_is_kept, stop_words
from cli.health import settled, well
from cli.options import add_json, add_profile, add_profile_options, add_running, count
from cli.report import TextReport
from cli.sessions import as_json, show, silent_as_json, silent_words
from launcher.client import client
from launcher.client.inbox import newer
from launcher.client.running import find_running, kill_supervisor, left_of, nodes_of
from launcher.errors import (
    AlreadyRunningError,
    ConnectionLostError,
    NotRunningError,
    SessionError,
    SilentSupervisorError,
    UnknownNodeError,
)
from launcher.events import ClosedEvent, LogEvent
from launcher.status import NodeState, NodeStatus, SessionInfo
from text.i18n import _, language, localized, ngettext
from text.output import RED, Paint, json_text, say_error, write
from text.plain import plain
from text.program import typable

UP_WITHIN_S = 60.0
"""When `up` stops waiting, whatever limits the profile has."""
LOOK_S = 0.05
STEADY_S = 0.5
"""How long all must stay up: a node that fails does so right after its start."""


def _up_options(parser: Parser) -> None:
    add_profile(parser)
    add_profile_options(parser)


def _logs_options(parser: Parser) -> None:
    parser.add_argument("node", nargs="?", metavar=_("NODE"), help=_("name of the node; all of them by default"))
    parser.add_argument("-f", "--follow", action="store_true", help=_("keep showing new lines"))
    parser.add_argument(
        "-n", dest="lines", metavar="N", type=count, default=100, help=_("how many past lines, 100 by default")
    )
    parser.add_argument("--profile", metavar=_("NAME"), help=_("which one, if several are running"))


@command("up", _up_options)
async def up_command(options: Namespace) -> int:
    """Start a profile in the background, wait until it is up, and show its nodes."""
    profile = profile_to_run(options)
    try:
        link = await client.launch(profile, foreground=False, node_lang=language(), supervisor=options.supervisor)
    except AlreadyRunningError as error:
        say_error(localized(error.args[0]))
        # Not a usage error: this very profile is running.
        return 1 if error.session.profile == str(profile.path) else error.exit_code
    try:
        try:
            await asyncio.wait_for(_settle(link), UP_WITHIN_S)
        except asyncio.TimeoutError:
            say_error(_("not everything is up yet; `deck ps` shows the progress"))
        optional = {name for name, node in profile.nodes.items() if node.optional}
        show(link.session, tuple(link.nodes.values()), optional)
        healthy = all(well(node, optional) for node in link.nodes.values())
    finally:
        await link.aclose()
    if stop_is_kept(profile.domain):
        say_error(stop_words(profile.domain))
    if healthy:
        write(typable(_("`deck attach` shows it, `deck down` stops it")))
    else:
        say_error(_("some nodes are not healthy; `deck logs NODE` shows why, `deck down` stops the profile"))
    return 0 if healthy else 1


async def _settle(link: client.SupervisorClient) -> None:
    """Wait until every node is up, or has failed to start, and this no longer changes."""
    listening = asyncio.ensure_future(_listen(link))
    try:
        before: list[NodeState] | None = None
        while before != (now := [node.state for node in link.nodes.values()]):
            if listening.done():
                raise ConnectionLostError(_("the supervisor ended while the nodes were starting"))
            before = now if settled(link.nodes) else None
            await asyncio.sleep(LOOK_S if before is None else STEADY_S)
    finally:
        listening.cancel()


async def _listen(link: client.SupervisorClient) -> None:
    """Consume the events, which keeps the statuses of the nodes up to date."""
    async for _event in link.events():
        pass


async def _asked_all() -> tuple[
    list[tuple[SessionInfo, tuple[NodeStatus, ...]]], list[tuple[SessionInfo, dict[str, int]]]
]:
    """Ask all supervisors; return the sessions with their nodes, and those that do not answer."""
    found: list[tuple[SessionInfo, tuple[NodeStatus, ...]]] = []
    silent: list[tuple[SessionInfo, dict[str, int]]] = []
    for session in client.running():
        try:
            link = await client.attach(session.run_id)
        except SilentSupervisorError:
            silent.append((session, nodes_of(session.run_id)))
            continue
        except SessionError:
            continue  # It has just ended.
        found.append((link.session, tuple(link.nodes.values())))
        await link.aclose()
    return found, silent


@command("ps", add_json)
async def ps_command(options: Namespace) -> int:
    """Show the running sessions; return 1 if the supervisor of one does not answer."""
    found, silent = await _asked_all()
    if options.json:
        answering = [as_json(*each) for each in found]
        write(json_text([*answering, *(silent_as_json(*each) for each in silent)], indent=2))
        return 1 if silent else 0
    if not found and not silent:
        say_error(str(localized(NotRunningError().args[0])))
    names = [session.name for session, _nodes in found]
    for index, (session, nodes) in enumerate(found):
        if index:
            write("")
        show(session, nodes)
        if stop_is_kept(session.domain):
            write(Paint(sys.stdout)(stop_words(session.domain), RED))
        if names.count(session.name) > 1:
            write(_("name of this run: {run_id}").format(run_id=session.run_id))
    for session, pids in silent:
        say_error(silent_words(session, pids))
    return 1 if silent else 0


@command("logs", _logs_options)
async def logs_command(options: Namespace) -> int:
    link = await _attached(options.profile, options.node)
    try:
        names = [options.node] if options.node else list(link.nodes)
        report = TextReport(write, names, Paint(sys.stdout))
        last: dict[str, int] = {}
        if options.lines:
            for line in await link.history(options.node, options.lines):
                report.log(line)
                last[line.node] = line.seq
        return await _follow(link, options.node, report, last) if options.follow else 0
    finally:
        await link.aclose()


async def _follow(link: client.SupervisorClient, node: str | None, report: TextReport, last: dict[str, int]) -> int:
    """Report the lines after the `last` ones, of all nodes or of one, until the session ends."""
    async for event in link.events():
        if isinstance(event, ClosedEvent):
            say_error(localized(event.reason))
            return int(event.reason == client.GONE)
        if isinstance(event, LogEvent):
            news = newer(event, last)
            for line in news.lines:
                if node in (None, line.node):
                    report.log(line)
            for name, count in news.skipped.items():
                if node in (None, name):
                    report.skipped(name, count)
    return 0


@command("down", add_running)
async def down_command(options: Namespace) -> int:
    try:
        link = await client.attach(options.name)
    except SilentSupervisorError:
        # What it has started ends with it.
        run_id = find_running(options.name).session.run_id
        say_error(localized(await kill_supervisor(run_id)))
        return 1 if left_of(run_id) else 0
    session, count = link.session, len(link.nodes)
    await link.shutdown()
    words = ngettext("{name} stopped, {count} node", "{name} stopped, {count} nodes", count)
    write(words.format(name=plain(session.name), count=count))
    return 0


async def _attached(name: str | None, node: str | None) -> client.SupervisorClient:
    """Attach by name; without one, to the only session that has the node."""
    sessions = client.running()
    if name is not None or node is None or len(sessions) < 2:
        link = await client.attach(name)
        if node is not None and node not in link.nodes:
            known = tuple(link.nodes)
            await link.aclose()
            raise UnknownNodeError(node, known)
        return link
    having: list[client.SupervisorClient] = []
    known_nodes: list[str] = []
    for session in sessions:
        link = await client.attach(session.run_id)
        known_nodes += link.nodes
        if node in link.nodes:
            having.append(link)
        else:
            await link.aclose()
    if len(having) == 1:
        return having[0]
    for link in having:
        await link.aclose()
    if not having:
        raise UnknownNodeError(node, known_nodes)
    return await client.attach(None)
