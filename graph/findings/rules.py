"""The rules by which a graph is examined, for one moment and over time.

What messages show (losses, clocks, silence) is only found for topics that are measured.
"""

from __future__ import annotations

import math
import os
from collections import Counter, defaultdict
from types import MappingProxyType
from typing import TYPE_CHECKING

from graph.data import PROCESS_NUMBERS, Trouble
from graph.findings.finding import (
    FORGOTTEN_S,
    SETTLED_S,
    FindingLevel,
    FindingPlace,
    GraphFinding,
    GraphNorms,
    is_deck,
    listed,
    meant,
)
from graph.housekeeping import is_hidden, is_housekeeping
from graph.qos import BEST_EFFORT, TRANSIENT_LOCAL, mismatches
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from graph.data import ActionRow, EndpointInfo, GraphUpdate, ServiceRow, TopicRow
    from graph.findings.finding import PlaceKind

ERROR, WARNING = FindingLevel
CLOCK = "/clock"


def examine(
    update: GraphUpdate, norms: GraphNorms | None = None, failures: Mapping[str, str] = MappingProxyType({})
) -> tuple[GraphFinding, ...]:
    """Return everything that is wrong with the graph now, the worst first.

    `failures`: full name to why, as translatable words, of nodes that have ended for good.
    """
    norms = norms or GraphNorms()
    found = [
        *_fights(update, norms),
        *_namesakes(update),
        *_disagreements(update),
        *_missing(update),
        *_misfits(update),
        *_losses(update),
        *_unfed(update, norms, one_has_failed=bool(failures)),
        *_unserved(update),
        *_clocks(update),
        *_silences(update, norms),
        *_failures(failures),
    ]
    return tuple(sorted(found, key=lambda finding: finding.rank))


def _on(
    row: TopicRow, level: FindingLevel, rule: str, what: str, mend: str, nodes: Iterable[str] | None = None
) -> GraphFinding:
    """Return a finding about a topic; those who publish it take part in it, if nobody is named."""
    taking_part = _nodes(row.published_by) if nodes is None else tuple(nodes)
    return GraphFinding(level, rule, FindingPlace("topic", row.name), what, mend, taking_part)


def _nodes(ends: Iterable[EndpointInfo]) -> tuple[str, ...]:
    return tuple(sorted({end.node for end in ends}))


def _failures(failed: Mapping[str, str]) -> Iterator[GraphFinding]:
    """Yield the nodes of the session that have ended for good, as whoever started them says."""
    for name, why in failed.items():
        what = say("It has failed, and is not started again: {reason}", reason=why)
        mend = say("Look at its log, and start it again once its fault is fixed.")
        yield GraphFinding(ERROR, "failed", FindingPlace("node", name), what, mend, (name,), settled_s=0.0)


# ---------------------------------------------------------------- who stands in whose way

DECK = "Deck"
"""What this screen is called in a sentence."""
PARTS = frozenset(
    {
        "diagnostic_msgs/msg/DiagnosticArray",
        "rcl_interfaces/msg/Log",
        "rcl_interfaces/msg/ParameterEvent",
        "tf2_msgs/msg/TFMessage",
        "visualization_msgs/msg/Marker",
        "visualization_msgs/msg/MarkerArray",
    }
)
"""Types of messages that are parts of a whole, to which everybody adds theirs."""
OF_EACH_NODE = ("/rosout", "/parameter_events")
"""A node has at most one publisher on each of these."""


def _fights(update: GraphUpdate, norms: GraphNorms) -> Iterator[GraphFinding]:
    """Yield the topics on which several publishers send at once, or might where one must not."""
    mend = say(
        "Stop all but one of them, or let the others publish another topic: remap it, or give them a namespace."
    )
    for row in update.topics:
        if row.name in norms.of_many or PARTS & set(row.type_names) or is_hidden(row.name):
            continue
        names = [end.node for end in row.published_by if not is_deck(end.node)]
        names += [DECK] if row.own_publishers else []
        commands = any(norms.moves(row.name, kind) for kind in row.type_names)
        strict = row.name in norms.sole or row.name == CLOCK
        if len(names) < 2 or not (strict or row.several_send):
            continue
        yield GraphFinding(
            ERROR if commands or strict else WARNING,
            "fight",
            FindingPlace("topic", row.name),
            _fight_words(row, listed(names), commands=commands or row.name in norms.sole),
            mend,
            tuple(sorted(set(names) - {DECK})),
            # Two of one name may be a node that was killed and its successor.
            FORGOTTEN_S if len(set(names)) < len(names) else SETTLED_S,
        )


def _fight_words(row: TopicRow, nodes: str, *, commands: bool) -> str:
    if row.name == CLOCK:
        return say("Several clocks are published, and time jumps between them: {nodes}", nodes=nodes)
    if commands and row.several_send:
        return say("Several nodes command at once, and whoever spoke last is obeyed: {nodes}", nodes=nodes)
    if commands:
        return say("Several nodes may command, and whoever spoke last is obeyed: {nodes}", nodes=nodes)
    return say("Messages of several publishers are mixed: {nodes}", nodes=nodes)


def _namesakes(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield the names that more than one node has."""
    twice: set[str] = set()
    for row in update.topics:
        if row.name in OF_EACH_NODE:
            counted = Counter(end.node for end in row.published_by if end.is_named)
            twice |= {name for name, count in counted.items() if count > 1}
    for node in update.nodes:
        if is_hidden(node.name) or not (node.name in twice or len(node.processes) > 1):
            continue
        yield GraphFinding(
            ERROR,
            "namesakes",
            FindingPlace("node", node.name),
            say(
                "Several nodes have this name: parameters and services reach any one of them, and "
                "nobody can tell their messages apart."
            ),
            say(
                "Stop the one that was left running, or give one another name: `--ros-args -r __node:=another_name`."
            ),
            (node.name,),
            SETTLED_S if _run_here(node.processes) else FORGOTTEN_S,
        )


def _run_here(numbers: Collection[int]) -> bool:
    """Whether these are several processes of this machine, so that none is only remembered."""
    here = {int(name) % PROCESS_NUMBERS for name in os.listdir("/proc") if name.isdigit()}  # noqa: PTH208
    return len(numbers) > 1 and here.issuperset(numbers)


# ---------------------------------------------------------------- types that do not agree, or are not installed

MOST_TYPES = 3
"""Types that are written out."""


def _disagreements(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield topics, services and actions that are used with more than one type."""
    for row in update.topics:
        if len(row.type_names) > 1 and not is_hidden(row.name):
            yield _two_types("topic", row, _who_uses(row), _nodes((*row.published_by, *row.subscribed_by)))
    for service in update.services:
        kinds = sorted({*service.type_names, *service.called_as})
        if len(kinds) > 1 and not is_hidden(service.name):
            callers = [node.name for node in update.nodes if service.name in node.clients]
            yield _two_types("service", service, ", ".join(kinds[:MOST_TYPES]), (*service.nodes, *callers))
    for action in update.actions:
        if len(action.type_names) > 1 and not is_hidden(action.name):
            words = ", ".join(action.type_names[:MOST_TYPES])
            yield _two_types("action", action, words, (*action.servers, *action.clients))


def _who_uses(row: TopicRow) -> str:
    """Return `std_msgs/msg/Bool (/a), std_msgs/msg/Int8 (/b)`."""
    users: defaultdict[str, list[str]] = defaultdict(list)
    for end in (*row.published_by, *row.subscribed_by):
        users[end.type_name].append(end.node)
    told = [f"{kind} ({listed(set(users[kind]))})" if users[kind] else kind for kind in row.type_names]
    return ", ".join(told[:MOST_TYPES])


def _two_types(
    kind: PlaceKind, row: TopicRow | ServiceRow | ActionRow, types: str, nodes: tuple[str, ...]
) -> GraphFinding:
    what = say("It is used with types that do not agree, so not everybody is reached: {types}", types=types)
    mend = say("Let all use one type, or give one of them another name.")
    return GraphFinding(ERROR, "two-types", FindingPlace(kind, row.name), what, mend, tuple(dict.fromkeys(nodes)))


def _missing(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield topics whose type is not installed here, unless peers disagree about it anyway."""
    for row in update.topics:
        if row.trouble is Trouble.UNKNOWN_TYPE and len(row.type_names) < 2:
            what = say(
                "Its messages cannot be read here: {type} is unknown, or another version of it.",
                type=", ".join(row.type_names) or "?",
            )
            yield _on(row, WARNING, "unknown-type", what, row.detail)


# ---------------------------------------------------------------- QoS, and messages that were lost

FEWEST_LOST = 20
LOST_SHARE = 0.05
"""A loss below these may happen on any busy machine."""
SHALLOW = 5
"""Depth of a queue that a burst overflows."""


def _misfits(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield topics on which some subscriber does not hear some publisher, by their QoS."""
    for row in update.topics:
        found = list(dict.fromkeys(mismatches(row.published_by, row.subscribed_by)))
        if not found or is_hidden(row.name):
            continue
        what, more = found[0].what, len(found) - 1
        if more:
            what = say("{what} (and {more} more such pairs)", what=what, more=more)
        nodes = sorted({name for pair in found for name in (pair.publisher, pair.subscriber)})
        yield _on(row, ERROR, "qos", what, found[0].mend, nodes)


def _losses(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield topics of which messages have been lost on the way to Deck."""
    for row in update.topics:
        lost = row.lost or 0
        if lost < FEWEST_LOST or lost < LOST_SHARE * (row.count + lost) or is_hidden(row.name):
            continue
        unreliable = any(end.reliability == BEST_EFFORT for end in row.published_by)
        yield _on(row, WARNING, "lost", *(_lost_best_effort(row, lost) if unreliable else _lost_reliable(row, lost)))


def _lost_best_effort(row: TopicRow, lost: int) -> tuple[str, str]:
    what = say(
        "{lost} of {sent} messages were lost on the way; with best_effort nobody sends them again.",
        lost=lost,
        sent=row.count + lost,
    )
    return what, say("Publish smaller messages or fewer a second; or offer reliable, if each of them matters.")


def _lost_reliable(row: TopicRow, lost: int) -> tuple[str, str]:
    what = say(
        "{lost} of {sent} messages were lost, although reliable: newer ones have replaced them in "
        "the publisher's queue.",
        lost=lost,
        sent=row.count + lost,
    )
    depth = min((end.depth for end in row.published_by if end.depth), default=0)
    if 0 < depth < SHALLOW:
        return what, say(
            "Give the publisher a deeper queue than {depth}, or let it publish less at once.", depth=depth
        )
    return what, say("Give the publisher a deeper queue, or let it publish less at once.")


# ---------------------------------------------------------------- who waits in vain


def _unfed(update: GraphUpdate, norms: GraphNorms, *, one_has_failed: bool = False) -> Iterator[GraphFinding]:
    """Yield topics that somebody hears and nobody publishes, with the name that was meant.

    A topic that may wait for somebody is one of them only if its name nearly matches; one that
    commands the robot also if a node has failed, which may be who published it.
    """
    fed = [row for row in update.topics if row.published_by and not is_housekeeping(row.name)]
    for row in update.topics:
        ends = [end for end in row.subscribed_by if not is_deck(end.node)]
        is_fed = row.publishers or row.own_publishers
        if is_fed or not ends or is_hidden(row.name) or row.name == CLOCK:
            continue
        speakers = {one.name: one for one in fed if not set(one.type_names).isdisjoint(row.type_names)}
        instead = meant(row.name, speakers)
        rests = not one_has_failed and any(norms.moves(row.name, kind) for kind in row.type_names)
        if not instead and (rests or row.name in norms.may_wait or is_housekeeping(row.name)):
            continue
        place, hearers = FindingPlace("topic", row.name), _nodes(ends)
        nodes = listed(hearers)
        # A node's name comes after its endpoints, and of a dead one it goes before them.
        settled_s = SETTLED_S if any(end.is_named for end in ends) else FORGOTTEN_S
        if instead:
            what = say(
                "Nobody publishes it, and it is heard by {nodes}; published is {instead}.",
                nodes=nodes,
                instead=instead,
            )
            taking_part = (*hearers, *(end.node for end in speakers[instead].published_by))
            mend, taking_part = _one_name(row.name, instead), tuple(dict.fromkeys(taking_part))
            yield GraphFinding(ERROR, "near-name", place, what, mend, taking_part, settled_s)
        else:
            what = say("Nobody publishes it, and it is heard by {nodes}.", nodes=nodes)
            mend = say("Start the node that publishes it, or remap it to a topic that is published.")
            yield GraphFinding(WARNING, "unfed", place, what, mend, hearers, settled_s)


def _one_name(name: str, instead: str) -> str:
    return say(
        "Let both use one name: correct it in the code, or remap it: `--ros-args -r {name}:={instead}`.",
        name=name,
        instead=instead,
    )


def _unserved(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield services and actions that somebody calls and nobody serves."""
    callers: defaultdict[str, list[str]] = defaultdict(list)
    for node in update.nodes:
        if not is_deck(node.name):
            for service in node.clients:
                callers[service].append(node.name)
    served = {row.name for row in update.services}
    own = [name for name in served if not is_housekeeping(name)]
    for name in sorted(callers.keys() - served):
        if not is_housekeeping(name):
            yield _nobody_serves(FindingPlace("service", name), callers[name], meant(name, own))
    acting = [row.name for row in update.actions if row.servers]
    for row in update.actions:
        clients = [name for name in row.clients if not is_deck(name)]
        if clients and not row.servers and not is_hidden(row.name):
            yield _nobody_serves(FindingPlace("action", row.name), clients, meant(row.name, acting))


def _nobody_serves(place: FindingPlace, callers: list[str], instead: str) -> GraphFinding:
    nodes = listed(callers)
    if instead:
        what = say(
            "Nobody serves it, and it is called by {nodes}; served is {instead}.", nodes=nodes, instead=instead
        )
        mend = _one_name(place.name, instead)
    else:
        what = say("Nobody serves it, and it is called by {nodes}.", nodes=nodes)
        mend = say("Start the node that serves it, or look for a misspelt or remapped name.")
    return GraphFinding(ERROR, "unserved", place, what, mend, tuple(dict.fromkeys(callers)))


# ---------------------------------------------------------------- clocks: stamps of another time, a time nobody tells

AHEAD_S = 0.1
"""How far a stamp may be ahead of its arrival: clocks that a network keeps together differ less."""
DAY_S = 86_400.0
LATE_S = 5.0
"""From here on, a clock that is slow is likelier than a message that was under way so long."""


def _clocks(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield what is wrong with the time of nodes and messages."""
    simulated = next((row for row in update.topics if row.name == CLOCK), None)
    if simulated is not None:
        yield from _simulated(update, simulated)
    told = simulated is not None and simulated.publishers > 0
    for row in update.topics:
        if is_hidden(row.name) or not row.published_by:
            continue
        if row.clock_off_s is not None:
            # With a simulation, stamps count from its start.
            if not told:
                yield _on(row, WARNING, "clock", *_other_clock(row.clock_off_s))
        elif row.latency_s is not None and any(end.durability != TRANSIENT_LOCAL for end in row.published_by):
            if row.latency_s < -AHEAD_S:
                yield _on(row, WARNING, "clock", *_ahead(-row.latency_s))
            elif row.latency_s > LATE_S:
                yield _on(row, WARNING, "clock", *_late(row.latency_s))


def _other_clock(off_s: float) -> tuple[str, str]:
    mend = say(
        "Stamp messages with the clock of the node (`get_clock().now()`), and set the clock of the "
        "computer or board that they come from."
    )
    days = abs(off_s) / DAY_S
    time = say("{n:.0f} min", n=abs(off_s) / 60.0) if days < 1.0 else say("{n:.0f} days", n=days)
    if off_s > 0:
        return say("Its stamps are {time} behind this computer.", time=time), mend
    return say("Its stamps are {time} ahead of this computer.", time=time), mend


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
    following = _nodes(end for end in row.subscribed_by if not is_deck(end.node))
    if not following:
        return
    if not row.publishers and not row.own_publishers:
        what = say(
            "Nobody publishes the simulated time (use_sim_time) that is followed by {nodes}: "
            "timers stand still there.",
            nodes=listed(following),
        )
        mend = say("Start the simulator, or `ros2 bag play --clock`; without either, set use_sim_time to false.")
        yield _on(row, ERROR, "no-clock", what, mend, following)
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
        what = say(
            "The clock of the computer is followed by {nodes}, a simulated time by "
            "{following}: their stamps do not fit together.",
            nodes=listed(others),
            following=listed(following),
        )
        yield _on(
            row, WARNING, "clock-mix", what, say("Set use_sim_time to true for all nodes, or for none."), others
        )


# ---------------------------------------------------------------- topics that have fallen silent

STREAMS = "sensor_msgs/msg/"
"""Types whose messages come all the time, if they come at all."""


def _silences(update: GraphUpdate, norms: GraphNorms) -> Iterator[GraphFinding]:
    """Yield topics that were published regularly until they stopped, and sensors that never began.

    Whatever is published now and then, such as commands, may rest.
    """
    for row in update.topics:
        if row.trouble is not Trouble.QUIET or row.recorded or is_housekeeping(row.name):
            continue
        if any(norms.moves(row.name, kind) for kind in row.type_names):
            continue
        nodes = _nodes(end for end in row.published_by if not is_deck(end.node))
        what = _silence_words(row, listed(nodes)) if nodes else ""
        if what:
            mend = say("Look at the log of the node and at its device; start it again if it hangs.")
            yield _on(row, WARNING, "silent", what, mend, nodes)


def _silence_words(row: TopicRow, nodes: str) -> str:
    if row.age_s is not None and row.steady_hz is not None:
        return say(
            "It came at {hz:.1f} Hz from {nodes}, and then nothing for {seconds:.0f} s.",
            nodes=nodes,
            hz=row.steady_hz,
            seconds=row.age_s,
        )
    latched = any(end.durability == TRANSIENT_LOCAL for end in row.published_by)
    streams = all(kind.startswith(STREAMS) for kind in row.type_names)
    if row.age_s is None and streams and not latched:
        return say("This sensor has not sent one message; it is published by {nodes}.", nodes=nodes)
    return ""


# ---------------------------------------------------------------- over time

CHANGING_S = 20.0
"""So long at most is a graph waited for whose nodes change."""


class LastingFindings:
    """The findings of one graph that have held for long enough: what holds while nodes start or end is not told.

    On a slow machine the nodes of a robot come one after the other, for longer than a finding takes to settle; so it
    settles once no node has come or gone for as long. Where one comes and goes for ever, it is reported nevertheless,
    after `CHANGING_S`.
    """

    def __init__(self, norms: GraphNorms) -> None:
        self._norms = norms
        self._since_s: dict[str, float] = {}
        self._found: tuple[GraphFinding, ...] = ()
        self._nodes: frozenset[str] = frozenset()
        self._changed_s = -math.inf
        self._told: set[str] = set()

    def take(self, update: GraphUpdate, now_s: float, failures: Mapping[str, str] = MappingProxyType({})) -> None:
        """Examine the graph as it is at `now_s`, on any clock that runs steadily.

        `failures`: full name to why, of nodes that have ended for good.
        """
        if update.error:
            return
        nodes = frozenset(node.name for node in update.nodes)
        if nodes != self._nodes:
            self._nodes, self._changed_s = nodes, now_s
        self._found = examine(update, self._norms, failures)
        self._since_s = {one.key: self._since_s.get(one.key, now_s) for one in self._found}
        self._told &= self._since_s.keys()

    def told(self, now_s: float) -> tuple[GraphFinding, ...]:
        """Return those that have held long enough by `now_s`, the worst first."""
        told = tuple(one for one in self._found if self._left_s(one, now_s) <= 0.0)
        self._told |= {one.key for one in told}
        return told

    def settles_in_s(self, now_s: float) -> float | None:
        """Return how long the last of those that are still to be reported needs; None without one."""
        left_s = [left for one in self._found if (left := self._left_s(one, now_s)) > 0.0]
        return max(left_s, default=None)

    def forget(self) -> None:
        """Start over, for another graph."""
        self._found, self._since_s = (), {}
        self._nodes, self._changed_s = frozenset(), -math.inf
        self._told = set()

    def _left_s(self, finding: GraphFinding, now_s: float) -> float:
        if finding.key in self._told:
            return 0.0
        held_s, same_s = now_s - self._since_s[finding.key], now_s - self._changed_s
        left_s = finding.settled_s - min(held_s, same_s)
        return left_s if held_s < CHANGING_S else finding.settled_s - held_s
