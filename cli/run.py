"""`deck run`: run a profile without a screen, from start to summary."""

from __future__ import annotations

import asyncio
import sys
import time
from argparse import Namespace
from typing import TYPE_CHECKING

from cli.commands import Parser, command
from cli.domains import profile_to_run, stop_is_kept, stop_words
from cli.health import over, settled, well
from cli.line_writer import LineWriter
from cli.options import add_json, add_profile, add_profile_options, seconds
from cli.report import JsonReport, Report, Summary, TextReport
from launcher.errors import SessionError
from launcher.events import ClosedEvent, Event, LogEvent, StatusEvent
from launcher.processes.ending import ENDING
from launcher.processes.interrupts import run
from launcher.profile.model import Profile
from launcher.status import NodeStatus
from text.i18n import _, language, localized, ngettext
from text.output import Paint, drop_output, say_error

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient
    from launcher.client.start import StartingSupervisor

INTERRUPTED = 130
PAST_LINES = 1000
"""How many lines are kept of the output before the client has connected."""


def _run_options(parser: Parser) -> None:
    add_profile(parser)
    parser.add_argument(
        "--for", dest="seconds", metavar="S", type=seconds, help=_("stop S seconds after all nodes are ready")
    )
    add_json(parser)
    add_profile_options(parser)
    parser.epilog = _(
        "Ctrl-C stops the nodes, dependants first; a second Ctrl-C does not wait. Exit code: 0 if"
        " every node stayed healthy, 1 if one failed, 2 if nothing could be started."
    )


@command("run", _run_options)
def run_command(options: Namespace) -> int:
    """Start a profile, report events, stop it; return 0 if every node stayed healthy."""
    profile = profile_to_run(options)
    if stop_is_kept(profile.domain):
        say_error(stop_words(profile.domain))
    return run(_main(profile, options))


async def _main(profile: Profile, options: Namespace) -> int:
    loop = asyncio.get_running_loop()
    run = Run(profile, options.seconds, options.supervisor)
    writer = LineWriter(
        sys.stdout.fileno(),
        sys.stdout.encoding or "utf-8",
        left_out=_left_out_json if options.json else _left_out_words,
        on_gone=lambda: loop.call_soon_threadsafe(run.stop),
    )
    run.report = (
        JsonReport(writer.write) if options.json else TextReport(writer.write, list(profile.nodes), Paint(sys.stdout))
    )
    for number in ENDING:
        loop.add_signal_handler(number, run.interrupt)
    try:
        return await run.to_the_end()
    finally:
        await asyncio.to_thread(writer.finish)
        if writer.gone:
            drop_output()


def _left_out_words(count: int) -> str:
    words = ngettext(
        "[deck] {count} line left out: whoever reads this is too slow",
        "[deck] {count} lines left out: whoever reads this is too slow",
        count,
    )
    return words.format(count=count)


def _left_out_json(count: int) -> str:
    return f'{{"event": "skipped", "node": null, "lines": {count}}}'


class Run:
    """One run of a profile in the foreground."""

    report: Report

    def __init__(self, profile: Profile, seconds: float | None, supervisor: StartingSupervisor) -> None:
        """`seconds`: how long to run once all nodes are up; None: until stopped."""
        self._profile = profile
        self._supervisor = supervisor
        self._seconds = seconds
        self._client: SupervisorClient | None = None
        self._starting: asyncio.Task[SupervisorClient] | None = None
        self._stopping: list[asyncio.Task[None]] = []
        self._timer: asyncio.TimerHandle | None = None
        self._told: dict[str, tuple[object, ...]] = {}
        self._before_stop: dict[str, NodeStatus] = {}
        self._on_the_way = False
        self._ever_bad: set[str] = set()
        self._asked_to_stop = 0

    async def to_the_end(self) -> int:
        began = time.monotonic()
        try:
            client = await self._start()
        except asyncio.CancelledError:
            return INTERRUPTED
        self.report.session(client.session)
        reason = ""
        async for event in client.events(past=PAST_LINES):
            if isinstance(event, ClosedEvent):
                reason = event.reason
            else:
                self._tell(event)
        partings = await asyncio.gather(*self._stopping, return_exceptions=True)
        await client.aclose()
        left = next((each.args[0] for each in partings if isinstance(each, SessionError)), "")
        if left:
            self.report.note(localized(left))
        code = self._summary(client, reason, time.monotonic() - began)
        return code or int(bool(left))

    def interrupt(self) -> None:
        """Stop at the user's request; the second time, at once."""
        if not self._asked_to_stop:
            self.report.note(_("stopping; Ctrl-C again does not wait"))
        self.stop()

    def stop(self) -> None:
        """Stop the nodes in order; the second time, at once."""
        self._asked_to_stop += 1
        client = self._client
        if client is None:
            if self._starting is not None:
                self._starting.cancel()
            return
        if self._asked_to_stop > 2:
            return
        if self._timer is not None:
            self._timer.cancel()
        if not self._before_stop:
            self._before_stop = dict(client.nodes)
            self._on_the_way = not settled(client.nodes)
        shutdown = client.shutdown(now=self._asked_to_stop > 1)
        self._stopping.append(asyncio.ensure_future(shutdown))

    async def _start(self) -> SupervisorClient:
        from launcher.client.client import launch

        self._starting = asyncio.ensure_future(
            launch(self._profile, foreground=True, node_lang=language(), supervisor=self._supervisor)
        )
        if self._asked_to_stop:
            self._starting.cancel()
        self._client = await self._starting
        return self._client

    def _tell(self, event: Event) -> None:
        if isinstance(event, LogEvent):
            for line in event.lines:
                self.report.log(line)
            for node, count in event.skipped.items():
                self.report.skipped(node, count)
        elif isinstance(event, StatusEvent):
            for status in event.nodes:
                self._tell_status(status)
            self._look()

    def _tell_status(self, node: NodeStatus) -> None:
        """Report changes of a node, except of its CPU and memory."""
        now = (node.state, node.detail, node.pid, node.restarts, node.exit_code, node.signal)
        if self._told.get(node.name) == now:
            return
        self._told[node.name] = now
        bad = node.crashed or node.restarts
        if bad and not self._asked_to_stop and not self._profile.nodes[node.name].optional:
            self._ever_bad.add(node.name)
        self.report.status(node)

    def _look(self) -> None:
        """Start counting the seconds once all nodes are up; end if all have ended."""
        if self._client is None or self._asked_to_stop:
            return
        nodes = self._client.nodes
        if over(nodes):
            self.report.note(_("every node has ended"))
            self.stop()
        elif self._seconds is not None and self._timer is None and settled(nodes):
            loop = asyncio.get_running_loop()
            self._timer = loop.call_later(self._seconds, self.stop)

    def _summary(self, client: SupervisorClient, reason: str, seconds: float) -> int:
        nodes = self._before_stop or client.nodes
        optional = {name for name, node in self._profile.nodes.items() if node.optional}
        healthy = {
            name: name not in self._ever_bad and well(node, optional, on_the_way=self._on_the_way)
            for name, node in nodes.items()
        }
        cut_short = "" if self._asked_to_stop else reason
        summary = Summary(list(nodes.values()), healthy, seconds, cut_short)
        self.report.summary(summary)
        return summary.exit_code
