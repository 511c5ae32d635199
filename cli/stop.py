"""`deck stop`: the emergency stop from a command line, by the road that needs no ROS.

The supervisor writes the stop where every node that obeys it looks, so it holds though discovery or
the middleware hangs. Whether it is obeyed the nodes say by ROS alone, and only that confirms it.
"""

from __future__ import annotations

import time
from argparse import Namespace
from collections.abc import Mapping, Sequence

from cli.commands import Parser, command
from cli.domains import stop_is_kept, stop_words
from cli.observing import domain_view
from launcher.client.running import find_running, running_records
from launcher.client.stop_road import StopRoad
from launcher.errors import LauncherError, NotRunningError
from launcher.runs.record import RunRecord
from robot.topics import EMERGENCY_STATE
from text.i18n import _, localized
from text.output import say_error, write
from text.plain import plain
from text.sentences import reason_of
from tui.emergency.nodes import NodeStop, present, reported_stops

CARRIED_WITHIN_S = 3.0
CONFIRMED_WITHIN_S = 30.0
"""A busy machine takes so long to look into the graph and to hear it; the stop is given before."""
FOUND_WITHIN_S = 5.0
"""If by then nobody is seen who could say anything, nobody will."""
SETTLED_S = 1.5
"""Nodes report once a second: after this no other is expected."""
LOOK_S = 0.02


def _stop_options(parser: Parser) -> None:
    parser.add_argument("name", nargs="?", metavar=_("NAME"), help=_("name of the profile; without it, all stop"))
    parser.epilog = _(
        "Exit code: 0 if all nodes that report on the emergency stop obey it, 1 if that is not "
        "confirmed within seconds. The stop holds until it is released."
    )


@command("stop", _stop_options)
def stop_command(options: Namespace) -> int:
    """Stop the robot of the session that is named, or of all; return 1 unless all confirm it."""
    records = running_records() if options.name is None else [find_running(options.name)]
    if not records:
        raise NotRunningError
    # All of them before anything that takes time.
    roads = {record.session.domain: _begun(record) for record in records}
    _wait_for(list(roads.values()))
    return max(_confirmed(record.session.name, record.session.domain) for record in records)


def _begun(record: RunRecord) -> StopRoad:
    road = StopRoad(record.folder, record.session.domain)
    road(True, time.time_ns())
    return road


def _wait_for(roads: Sequence[StopRoad]) -> None:
    deadline_s = time.monotonic() + CARRIED_WITHIN_S
    while any(road.is_busy for road in roads) and time.monotonic() < deadline_s:
        time.sleep(LOOK_S)


def _confirmed(name: str, domain: int) -> int:
    """Say what has become of it in one domain; return the exit code."""
    if not stop_is_kept(domain):
        say_error(
            _("deck: the stop of {name} could not be written: `deck down` ends its nodes, or cut the power").format(
                name=plain(name)
            )
        )
        return 1
    say_error(stop_words(domain))
    try:
        nodes = _reports(domain)
    except (LauncherError, OSError) as error:
        say_error(f"deck: {plain(localized(reason_of(error)))}")
        nodes = {}
    holding = sorted(node for node, stop in nodes.items() if stop.engaged)
    if holding and len(holding) == len(nodes):
        write(_("obeyed by {nodes}").format(nodes=", ".join(map(plain, holding))))
        return 0
    if nodes:
        free = ", ".join(plain(node) for node in sorted(set(nodes) - set(holding)))
        say_error(_("deck: not obeyed yet by {nodes}").format(nodes=free))
    else:
        say_error(
            _(
                "deck: nobody has confirmed it: either the nodes cannot be heard, or none of "
                "{name} obeys an emergency stop; `deck down` ends them"
            ).format(name=plain(name))
        )
    return 1


def _reports(domain: int) -> Mapping[str, NodeStop]:
    """Return what the nodes say, once all that say something obey, or time is up.

    Raises:
        LauncherError: if ROS cannot be used.
    """
    nodes: dict[str, NodeStop] = {}
    changed_s = time.monotonic()
    last_s, deadline_s = changed_s + CONFIRMED_WITHIN_S, 0.0
    with domain_view(domain, followed=frozenset({EMERGENCY_STATE})) as view:
        while time.monotonic() < (deadline_s or last_s):
            for update in view.updates():
                deadline_s = deadline_s or time.monotonic() + FOUND_WITHIN_S
                if any(row.name == EMERGENCY_STATE and row.publishers for row in update.topics):
                    deadline_s = last_s
                known, nodes = nodes, present(reported_stops(nodes, update), update)
                if known.keys() != nodes.keys():
                    changed_s = time.monotonic()
            all_hold = bool(nodes) and all(stop.engaged for stop in nodes.values())
            if all_hold and time.monotonic() > changed_s + SETTLED_S:
                break
    return nodes
