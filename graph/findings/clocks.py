"""Clocks that do not agree: stamps of another time, simulated time that nobody tells."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.findings.finding import FindingLevel, FindingPlace, GraphFinding
from graph.findings.names import is_deck, listed
from graph.findings.publishers import CLOCK
from graph.housekeeping import is_hidden, is_housekeeping
from graph.qos import TRANSIENT_LOCAL
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

    from graph.data import GraphUpdate, TopicRow

AHEAD_S = 0.1
"""How far a stamp may be ahead of its arrival: clocks that a network keeps together differ less."""
DAY_S = 86_400.0
LATE_S = 5.0
"""From here on, a clock that is slow is likelier than a message that was under way so long."""


def clocks(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield what is wrong with the time of nodes and messages."""
    simulated = {row.name: row for row in update.topics}.get(CLOCK)
    if simulated is not None:
        yield from _simulated(update, simulated)
    told = simulated is not None and simulated.publishers > 0
    for row in update.topics:
        if is_hidden(row.name) or not row.published_by:
            continue
        if row.clock_off_s is not None:
            # With a simulation, stamps count from its start.
            if not told:
                yield _stamped(row, *_other_clock(row.clock_off_s))
        elif row.latency_s is not None and not _is_latched(row):
            if row.latency_s < -AHEAD_S:
                yield _stamped(row, *_ahead(-row.latency_s))
            elif row.latency_s > LATE_S:
                yield _stamped(row, *_late(row.latency_s))


def _is_latched(row: TopicRow) -> bool:
    return all(end.durability == TRANSIENT_LOCAL for end in row.published_by)


def _stamped(row: TopicRow, what: str, mend: str) -> GraphFinding:
    return GraphFinding(
        FindingLevel.WARNING,
        "clock",
        FindingPlace("topic", row.name),
        what,
        mend,
        tuple(sorted({end.node for end in row.published_by})),
    )


def _other_clock(off_s: float) -> tuple[str, str]:
    mend = say(
        "Stamp messages with the clock of the node (`get_clock().now()`), and set the clock of the "
        "computer or board that they come from."
    )
    days, minutes = abs(off_s) / DAY_S, abs(off_s) / 60.0
    if off_s > 0:
        if days < 1.0:
            what = say("Its stamps are {minutes:.0f} min behind this computer.", minutes=minutes)
        else:
            what = say("Its stamps are {days:.0f} days behind this computer.", days=days)
    elif days < 1.0:
        what = say("Its stamps are {minutes:.0f} min ahead of this computer.", minutes=minutes)
    else:
        what = say("Its stamps are {days:.0f} days ahead of this computer.", days=days)
    return what, mend


def _ahead(seconds: float) -> tuple[str, str]:
    return (
        say("Its messages are stamped {seconds:.1f} s in the future.", seconds=seconds),
        say("Let both computers take their time from one server (chrony), and look: `timedatectl`."),
    )


def _late(seconds: float) -> tuple[str, str]:
    return (
        say("Its messages arrive {seconds:.1f} s after their stamp.", seconds=seconds),
        say(
            "Either the clock of the sender is slow (`timedatectl`), or they are under way for so "
            "long: stamp a message when its data is taken, and publish it at once."
        ),
    )


def _simulated(update: GraphUpdate, row: TopicRow) -> Iterator[GraphFinding]:
    """Yield nodes that wait for a simulated time, or do without it while others follow it.

    A node follows it by subscribing to /clock (`use_sim_time`).
    """
    following = sorted({end.node for end in row.subscribed_by if not is_deck(end.node)})
    if not following:
        return
    if not row.publishers and not row.own_publishers:
        yield GraphFinding(
            FindingLevel.ERROR,
            "no-clock",
            FindingPlace("topic", CLOCK),
            say(
                "Nobody publishes the simulated time (use_sim_time) that is followed by {nodes}: "
                "timers stand still there.",
                nodes=listed(following),
            ),
            say("Start the simulator, or `ros2 bag play --clock`; without either, set use_sim_time to false."),
            tuple(following),
        )
        return
    telling = {end.node for end in row.published_by}
    others = [
        node.name
        for node in update.nodes
        if node.name not in telling
        and node.name not in following
        and not is_hidden(node.name)
        and any(not is_housekeeping(name) for name in node.publishes)
    ]
    if others:
        yield GraphFinding(
            FindingLevel.WARNING,
            "clock-mix",
            FindingPlace("topic", CLOCK),
            say(
                "The clock of the computer is followed by {nodes}, a simulated time by "
                "{following}: their stamps do not fit together.",
                nodes=listed(others),
                following=listed(following),
            ),
            say("Set use_sim_time to true for all nodes, or for none."),
            tuple(others),
        )
