"""`deck doctor --graph`: what is wrong with the running ROS graph, whoever has started it."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Sequence
from typing import NamedTuple

from cli.doctor.finding import Finding, fail, warn
from cli.observing import FOUND_S, domain_view, tell_that_it_takes_time
from graph.data import GraphUpdate
from graph.findings.finding import FORGOTTEN_S, FindingLevel, GraphFinding
from graph.findings.rules import LastingFindings
from graph.housekeeping import is_housekeeping
from launcher.processes.interrupts import run
from text.i18n import N_, _, localized
from text.plain import plain
from tui.session.bypass import NORMS

LISTEN_S = FOUND_S + 2.0
"""Long enough to find everybody, and to hear whether what they say is regular."""
MOST_S = LISTEN_S + FORGOTTEN_S + 5.0
"""A graph in which something comes and goes all the time is taken as it is."""
_PLACES = {
    "topic": N_("topic {name}: {what}"),
    "service": N_("service {name}: {what}"),
    "action": N_("action {name}: {what}"),
    "node": N_("node {name}: {what}"),
}


class GraphExamination(NamedTuple):
    """The findings of one domain, and the graph that they were found in."""

    domain: int
    update: GraphUpdate
    found: Sequence[GraphFinding]

    def for_programs(self) -> list[dict[str, object]]:
        """Return the findings as they are written with `--json`."""
        return [
            {
                **line.for_programs(),
                "text": localized(one.what),
                "place": {"kind": one.place.kind, "name": one.place.name},
                "nodes": list(one.nodes),
            }
            for one, line in zip(self.found, self.lines(), strict=True)
        ]

    def lines(self) -> list[Finding]:
        return [
            (fail if one.level is FindingLevel.ERROR else warn)(
                f"graph.{one.rule}",
                _(_PLACES[one.place.kind]).format(name=plain(one.place.name), what=localized(one.what)),
                localized(one.mend),
            )
            for one in self.found
        ]

    def summary(self) -> str:
        rows = (self.update.nodes, self.update.topics, self.update.services)
        nodes, topics, services = (sum(not is_housekeeping(row.name) for row in of_kind) for of_kind in rows)
        words = _("domain {domain}: nodes: {nodes}, topics: {topics}, services: {services}")
        told = words.format(domain=self.domain, nodes=nodes, topics=topics, services=services)
        count = _("findings: {count}").format(count=len(self.found)) if self.found else _("no findings")
        return f"{told} · {count}"


def examine_graph(asked: int | None, wanted: str | None = None) -> GraphExamination:
    """Look at the graph until it is known and all that is wrong has lasted.

    Raises:
        UsageError: if ROS cannot be used, or nobody is in the domain.
    """
    with domain_view(asked, wanted, all_topics=True) as view:
        words = _("looking at domain {domain} for {seconds} s").format(domain=view.domain, seconds=round(LISTEN_S))
        tell_that_it_takes_time(words)
        lasting, update = LastingFindings(NORMS), GraphUpdate(0.0)
        failures = run(_failures(view.domain))
        while True:
            for update in view.updates():
                lasting.take(update, time.monotonic(), failures)
            now_s, passed_s = time.monotonic(), view.listened_s()
            settled = view.is_at_rest() and lasting.settles_in_s(now_s) is None
            if passed_s >= MOST_S or (passed_s >= LISTEN_S and settled):
                view.refuse_empty(update)
                return GraphExamination(view.domain, update, lasting.told(now_s))


async def _failures(domain: int) -> dict[str, str]:
    """Return the nodes that the sessions in a domain say have ended for good, and why."""
    from launcher.client import client
    from launcher.errors import LauncherError
    from tui.graph.index import failures_of

    found: dict[str, str] = {}
    for session in client.running():
        if session.domain != domain:
            continue
        # It may just have ended.
        with contextlib.suppress(LauncherError):
            link = await client.attach(session.run_id)
            found |= failures_of(link.nodes.values())
            await link.aclose()
    return found
