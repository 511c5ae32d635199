"""Why something is not there: a node that has ended, a topic of a similar name, another type."""

from __future__ import annotations

from collections.abc import Iterable

from course.judge.evidence import Evidence, Observation, missed
from graph.data import Trouble
from launcher.status import NodeState
from text.sentences import say
from text.suggestions import nearest

_COMPARE = say("Compare the name of the topic letter by letter.")
_DOWN = (NodeState.FAILED, NodeState.BACKOFF, NodeState.EXITED)


def dead_nodes(evidence: Evidence) -> str:
    """Say which node of the profile does not run as meant, and why; empty if all do.

    What is wrong with a learner's own file comes first: an older process may still run.
    """
    nodes = evidence.nodes.values()
    faults = {node.name: node.fault for node in nodes if node.fault is not None}
    severe = [
        name for name, fault in faults.items() if evidence.nodes[name].state in _DOWN or fault.kind != "warning"
    ]
    down = [node for node in nodes if node.state in _DOWN]
    if down and not severe:
        return say("{node} does not run: {why}", node=down[0].name, why=down[0].detail or down[0].state.value)
    return next((say("{node}: {why}", node=name, why=faults[name].words) for name in (*severe, *faults)), "")


def but(words: str, name: str, names: Iterable[str]) -> str:
    """Return the words that something is not there, and what there is of a similar name."""
    meant = nearest(name, list(names))
    return say("{words}, but {meant}", words=words, meant=meant) if meant else words


def no_topic(evidence: Evidence, topic: str) -> Observation:
    meant = nearest(topic, [row.name for row in evidence.update.topics if row.publishers and row.name != topic])
    if meant:
        return missed(say("nobody publishes {topic}, but {meant} is published", topic=topic, meant=meant), _COMPARE)
    return missed(
        say("nobody publishes {topic}", topic=topic),
        dead_nodes(evidence) or say("Is create_publisher called in __init__, and is the name of the topic right?"),
    )


def nobody_subscribes(evidence: Evidence, topic: str) -> Observation:
    meant = nearest(topic, [row.name for row in evidence.update.topics if row.subscribed_by and row.name != topic])
    if meant:
        seen = say("nobody subscribes to {topic}, but {meant} is subscribed to", topic=topic, meant=meant)
        return missed(seen, _COMPARE)
    return missed(
        say("nobody subscribes to {topic}", topic=topic),
        dead_nodes(evidence) or say("Is create_subscription called in __init__, with the right name?"),
    )


def wrong_type(topic: str, wanted: str, found: tuple[str, ...]) -> Observation:
    return missed(
        say("{topic} has the type {found}, not {wanted}", topic=topic, found=", ".join(found), wanted=wanted),
        say("Compare the import of the message and the type in create_publisher."),
    )


def no_messages(evidence: Evidence, topic: str, type_name: str) -> Observation:
    row = evidence.topic(topic)
    if row is None or not row.publishers:
        return no_topic(evidence, topic)
    published = tuple(dict.fromkeys(end.type_name for end in row.published_by))
    if type_name and published and published != (type_name,):
        return wrong_type(topic, type_name, published)
    if row.trouble in (Trouble.QOS_MISMATCH, Trouble.UNKNOWN_TYPE):
        return missed(row.detail)
    return missed(
        say("no message has come on {topic}", topic=topic),
        dead_nodes(evidence) or say("Is publish called? By a timer, or in the callback?"),
    )
