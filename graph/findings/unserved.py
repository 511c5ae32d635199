"""Who waits in vain: subscribers that nobody feeds, callers of what nobody serves."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from graph.findings.finding import FORGOTTEN_S, SETTLED_S, FindingLevel, FindingPlace, GraphFinding
from graph.findings.names import is_deck, listed, meant
from graph.findings.publishers import CLOCK
from graph.housekeeping import is_hidden, is_housekeeping
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from graph.data import GraphUpdate, TopicRow
    from graph.findings.finding import GraphNorms


def unfed(update: GraphUpdate, norms: GraphNorms, *, one_has_failed: bool = False) -> Iterator[GraphFinding]:
    """Yield topics that somebody hears and nobody publishes, with the name that was meant.

    A topic that may wait for somebody is one of them only if its name nearly matches; one that
    commands the robot also if a node has failed, which may be who published it.
    """
    fed = {
        row.name: set(row.type_names) for row in update.topics if row.published_by and not is_housekeeping(row.name)
    }
    for row in update.topics:
        ends = [end for end in row.subscribed_by if not is_deck(end.node)]
        hearers = sorted({end.node for end in ends})
        if row.publishers or row.own_publishers or not hearers or is_hidden(row.name):
            continue
        if row.name == CLOCK:
            continue
        instead = meant(row.name, _of_one_type(row, fed))
        rests = not one_has_failed and any(norms.moves(row.name, kind) for kind in row.type_names)
        waits = rests or row.name in norms.may_wait
        if not instead and (waits or is_housekeeping(row.name)):
            continue
        place = FindingPlace("topic", row.name)
        nodes = listed(hearers)
        # A node's name comes after its endpoints, and of a dead one it goes before them.
        settled_s = SETTLED_S if any(end.is_named for end in ends) else FORGOTTEN_S
        if instead:
            speakers = next(one.published_by for one in update.topics if one.name == instead)
            yield GraphFinding(
                FindingLevel.ERROR,
                "near-name",
                place,
                say(
                    "Nobody publishes it, and it is heard by {nodes}; published is {instead}.",
                    nodes=nodes,
                    instead=instead,
                ),
                _one_name(row.name, instead),
                tuple(dict.fromkeys((*hearers, *(end.node for end in speakers)))),
                settled_s,
            )
        else:
            yield GraphFinding(
                FindingLevel.WARNING,
                "unfed",
                place,
                say("Nobody publishes it, and it is heard by {nodes}.", nodes=nodes),
                say("Start the node that publishes it, or remap it to a topic that is published."),
                tuple(hearers),
                settled_s,
            )


def _of_one_type(row: TopicRow, fed: dict[str, set[str]]) -> Iterable[str]:
    """Return the published topics that could take the place of this one."""
    return [name for name, kinds in fed.items() if kinds & set(row.type_names)]


def _one_name(name: str, instead: str) -> str:
    return say(
        "Let both use one name: correct it in the code, or remap it: `--ros-args -r {name}:={instead}`.",
        name=name,
        instead=instead,
    )


def unserved(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield services and actions that somebody calls and nobody serves."""
    callers: defaultdict[str, list[str]] = defaultdict(list)
    for node in update.nodes:
        if not is_deck(node.name):
            for service in node.clients:
                callers[service].append(node.name)
    served = [row.name for row in update.services]
    for name in sorted(callers.keys() - set(served)):
        if not is_housekeeping(name):
            own = [each for each in served if not is_housekeeping(each)]
            yield _unserved(FindingPlace("service", name), callers[name], meant(name, own))
    acting = [row.name for row in update.actions if row.servers]
    for row in update.actions:
        clients = [name for name in row.clients if not is_deck(name)]
        if clients and not row.servers and not is_hidden(row.name):
            yield _unserved(FindingPlace("action", row.name), clients, meant(row.name, acting))


def _unserved(place: FindingPlace, callers: list[str], instead: str) -> GraphFinding:
    nodes = listed(callers)
    if instead:
        what = say(
            "Nobody serves it, and it is called by {nodes}; served is {instead}.", nodes=nodes, instead=instead
        )
        mend = _one_name(place.name, instead)
    else:
        what = say("Nobody serves it, and it is called by {nodes}.", nodes=nodes)
        mend = say("Start the node that serves it, or look for a misspelt or remapped name.")
    return GraphFinding(FindingLevel.ERROR, "unserved", place, what, mend, tuple(dict.fromkeys(callers)))
