"""Checks of what stands in the graph: nodes, publishers, subscriptions and their QoS."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from course.judge.evidence import MET, Observation, is_decks, same_name
from course.judge.missing import dead_nodes, no_topic, wrong_type
from text.sentences import say
from text.suggestions import nearest

if TYPE_CHECKING:
    from course.judge.evidence import Evidence
    from graph.data import EndpointInfo
    from launcher.profile.steps.checks import NodeCheck, NoPublisherCheck, QosCheck, SubscriptionCheck, TopicCheck

STAYS_S = 1.0
"""How long a node must at least have been in the graph."""
ABSENT_S = 1.0
"""How long nobody must publish what nobody is to publish: discovery takes its time."""


async def node(check: NodeCheck, evidence: Evidence) -> Observation:
    """Wait for a node, and see that it is there a while later: one without a spin ends at once."""
    deadline_s = time.monotonic() + check.within
    while True:
        left_s = deadline_s - time.monotonic()
        observation = await evidence.until(lambda: _is_there(check, evidence), max(left_s, 0))
        if not observation.met:
            return observation
        pid = _pid(check, evidence)
        await evidence.let_pass(STAYS_S)
        if _is_there(check, evidence).met and _pid(check, evidence) == pid:
            return MET


def _pid(check: NodeCheck, evidence: Evidence) -> int | None:
    process = evidence.nodes.get(check.node.lstrip("/"))
    return process.pid if process is not None else None


def _is_there(check: NodeCheck, evidence: Evidence) -> Observation:
    """A node is in the graph, and its process runs: the graph forgets a dead one only later."""
    wanted = "/" + check.node.lstrip("/")
    process = evidence.nodes.get(wanted.lstrip("/"))
    if evidence.node(wanted) is not None and (process is None or process.state.alive):
        return MET
    meant = nearest(wanted, [row.name for row in evidence.update.nodes])
    seen = say("there is no node {node}", node=wanted)
    if meant:
        seen = say("there is no node {node}, but {meant}", node=wanted, meant=meant)
    return Observation(
        met=False,
        seen=seen,
        look=dead_nodes(evidence) or say("Is the node made in main, and does rclpy.spin get it?"),
    )


def topic(check: TopicCheck, evidence: Evidence, _since_s: float) -> Observation:
    """Somebody publishes a topic, by its type."""
    row = evidence.topic(check.topic)
    ends = row.published_by if row is not None else ()
    if not ends:
        return no_topic(evidence, check.topic)
    types = tuple(dict.fromkeys(end.type_name for end in ends))
    if types != (check.type,):
        return wrong_type(check.topic, check.type, types)
    if check.by and not any(same_name(end.node, check.by) for end in ends):
        return Observation(met=False, seen=_published_by_others(check.topic, ends))
    if check.publishers is not None and len(ends) != check.publishers:
        return Observation(
            met=False,
            seen=say("{topic} has {n} publishers: {nodes}", topic=check.topic, n=len(ends), nodes=_names(ends)),
        )
    return MET


def subscription(check: SubscriptionCheck, evidence: Evidence, _since_s: float) -> Observation:
    """Somebody subscribes to a topic."""
    row = evidence.topic(check.subscription)
    ends = row.subscribed_by if row is not None else ()
    ours = [end for end in ends if not check.by or same_name(end.node, check.by)]
    if not ours:
        seen = say("nobody subscribes to {topic}", topic=check.subscription)
        if check.by:
            seen = say("{node} does not subscribe to {topic}", node=check.by, topic=check.subscription)
        return Observation(met=False, seen=seen, look=dead_nodes(evidence) or _near_subscription(check, evidence))
    types = tuple(dict.fromkeys(end.type_name for end in ours))
    if check.type and types != (check.type,):
        return wrong_type(check.subscription, check.type, types)
    return MET


def qos(check: QosCheck, evidence: Evidence, _since_s: float) -> Observation:
    """Publishers or subscriptions have a QoS."""
    row = evidence.topic(check.qos)
    every = () if row is None else row.published_by if check.of == "publisher" else row.subscribed_by
    ends = [end for end in every if not check.by or same_name(end.node, check.by)]
    if not ends:
        if check.of == "publisher":
            return no_topic(evidence, check.qos)
        return Observation(met=False, seen=say("nobody subscribes to {topic}", topic=check.qos))
    for end in ends:
        for wanted, found in ((check.reliability, end.reliability), (check.durability, end.durability)):
            if wanted is not None and wanted != found:
                return Observation(
                    met=False,
                    seen=say("{node}: {found}, not {wanted}", node=end.node, found=found, wanted=wanted),
                    look=say("The QoS is the last argument: a QoSProfile instead of a number."),
                )
    return MET


async def no_publisher(check: NoPublisherCheck, evidence: Evidence) -> Observation:
    """Nobody publishes a topic for some time, except the nodes that may."""
    since_s, given = time.monotonic(), check.except_nodes or []
    allowed = [given] if isinstance(given, str) else given

    def look() -> Observation | None:
        row = evidence.topic(check.no_publisher)
        ends = [
            end
            for end in (row.published_by if row is not None else ())
            if not any(same_name(end.node, node) for node in allowed) and not is_decks(end.node)
        ]
        if ends:
            seen = _published_by_others(check.no_publisher, ends)
            return Observation(met=False, seen=seen, final=True)
        return MET if time.monotonic() - since_s >= ABSENT_S else None

    return await evidence.until(look, ABSENT_S + 1)


def _near_subscription(check: SubscriptionCheck, evidence: Evidence) -> str:
    topics = [
        row.name
        for row in evidence.update.topics
        if any(not check.by or same_name(end.node, check.by) for end in row.subscribed_by)
    ]
    meant = nearest(check.subscription, topics)
    if meant:
        return say("There is a subscription to {meant}: compare the names.", meant=meant)
    return say("Is create_subscription called in __init__, with the right name?")


def _published_by_others(topic: str, ends: list[EndpointInfo] | tuple[EndpointInfo, ...]) -> str:
    return say("{topic} is published by {nodes}", topic=topic, nodes=_names(ends))


def _names(ends: list[EndpointInfo] | tuple[EndpointInfo, ...]) -> str:
    return ", ".join(dict.fromkeys(end.node for end in ends))
