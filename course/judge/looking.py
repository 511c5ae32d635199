"""The kinds of checks that only look at what is there and what has come: topics, fields of messages, the log.

And why something is not there: a node that has ended, a topic of a similar name, another type.
"""

from __future__ import annotations

import math
import re
import time
from collections.abc import Iterable, Sequence
from typing import Any

from course.judge.evidence import MET, Evidence, Observation, is_decks, missed, same_name
from course.judge.fields import FieldMissingError, differs, field_at, shown
from graph.data import EndpointInfo, Sample, Trouble
from launcher.profile.steps.checks import FieldCheck, LogCheck, SubscriptionCheck, TopicCheck
from launcher.status import NodeState
from text.sentences import reason_of, say
from text.suggestions import nearest

ABSENT_S = 1.0
"""How long nobody must publish what nobody is to publish: discovery takes its time."""
_COMPARE = say("Compare the name of the topic letter by letter.")
_DOWN = (NodeState.FAILED, NodeState.BACKOFF, NodeState.EXITED)
FEW = 3
"""Messages that show whether something changes."""


def topic(check: TopicCheck, evidence: Evidence, since_s: float) -> Observation | None:
    """Somebody publishes a topic, by its type, at a rate; or nobody does, or too little."""
    if check.silent is not None:
        return _silent(check, check.silent, evidence, since_s)
    row = evidence.topic(check.topic)
    ends = row.published_by if row is not None else ()
    found = _published(check, ends, evidence) if check.only is None else _only(check.topic, check.only, ends, since_s)
    return _rate(check, check.rate, evidence, since_s) if check.rate is not None and found is MET else found


def _published(check: TopicCheck, ends: Sequence[EndpointInfo], evidence: Evidence) -> Observation:
    if not ends:
        return no_topic(evidence, check.topic)
    types = tuple(dict.fromkeys(end.type_name for end in ends))
    if types != (check.type,):
        return wrong_type(check.topic, check.type, types)
    if check.by and not any(same_name(end.node, check.by) for end in ends):
        return missed(_published_by(check.topic, ends))
    if check.publishers is not None and len(ends) != check.publishers:
        return missed(say("{topic} has {n} publishers: {nodes}", topic=check.topic, n=len(ends), nodes=_names(ends)))
    return MET


def _silent(check: TopicCheck, for_s: float, evidence: Evidence, since_s: float) -> Observation | None:
    if evidence.messages(check.topic, since_s):
        return missed(say("a message came on {topic}", topic=check.topic), final=True)
    return MET if time.time() - since_s >= for_s else None


def _only(name: str, allowed: Sequence[str], ends: Sequence[EndpointInfo], since_s: float) -> Observation | None:
    strangers = [
        end for end in ends if not any(same_name(end.node, node) for node in allowed) and not is_decks(end.node)
    ]
    if strangers:
        return missed(_published_by(name, strangers), final=True)
    return MET if time.time() - since_s >= ABSENT_S else None


def _rate(check: TopicCheck, wanted: tuple[float, float], evidence: Evidence, since_s: float) -> Observation | None:
    now_s, since_s = time.time(), max(since_s, evidence.fresh_s(check.topic))
    window_s = min(check.over, now_s - since_s)
    messages = evidence.messages(check.topic, now_s - window_s)
    if not messages:
        return no_messages(evidence, check.topic, check.type)
    first_s = evidence.messages(check.topic, since_s)[0].received_s
    if now_s - first_s < check.over and not (now_s - since_s > 2 * check.over):
        return None
    hz = _hz(messages, window_s)
    if wanted[0] <= hz <= wanted[1]:
        return MET
    return missed(
        say("{topic} comes {hz} times a second", topic=check.topic, hz=_about(hz, wanted)),
        say("Look at the period of the timer: it is in seconds, 1 / rate."),
    )


def _hz(messages: Sequence[Sample], window_s: float) -> float:
    if len(messages) < 2:
        return len(messages) / window_s
    span_s = messages[-1].received_s - messages[0].received_s
    return (len(messages) - 1) / span_s if span_s > 0 else math.inf


def _about(hz: float, wanted: tuple[float, float]) -> str:
    """Return a rate so coarsely that it is the same in each run, but not as one that is right."""
    if not 0 < hz < math.inf:
        return f"{hz:g}"
    step = 10 ** math.floor(math.log10(hz)) / 2
    about = round(hz / step) * step
    return f"{hz:.2f}" if wanted[0] <= about <= wanted[1] else f"{about:g}"


def _published_by(name: str, ends: Sequence[EndpointInfo]) -> str:
    return say("{topic} is published by {nodes}", topic=name, nodes=_names(ends))


def _names(ends: Sequence[EndpointInfo]) -> str:
    return ", ".join(dict.fromkeys(end.node for end in ends))


def subscription(check: SubscriptionCheck, evidence: Evidence, _since_s: float) -> Observation:
    row, by = evidence.topic(check.subscription), check.by or ""
    ends = row.subscribed_by if row is not None else ()
    ours = [end for end in ends if not by or same_name(end.node, by)]
    if not ours and not by:
        return nobody_subscribes(evidence, check.subscription)
    if not ours:
        seen = say("{node} does not subscribe to {topic}", node=by, topic=check.subscription)
        topics = evidence.update.topics
        names = [row.name for row in topics if any(same_name(end.node, by) for end in row.subscribed_by)]
        meant = nearest(check.subscription, names)
        look = say("Is create_subscription called in __init__, with the right name?")
        if meant:
            look = say("There is a subscription to {meant}: compare the names.", meant=meant)
        return missed(seen, dead_nodes(evidence) or look)
    types = tuple(dict.fromkeys(end.type_name for end in ours))
    if check.type and types != (check.type,):
        return wrong_type(check.subscription, check.type, types)
    return MET


def field(check: FieldCheck, evidence: Evidence, since_s: float) -> Observation:
    """A field of the newest messages has a value.

    After a message was published, any that complies will do: others may come beside it.
    """
    messages = evidence.messages(check.field, since_s or evidence.fresh_s(check.field))
    count = max(check.messages, FEW) if check.changes else check.messages
    if len(messages) < count:
        return no_messages(evidence, check.field, check.type)
    if messages[-1].type_name != check.type:
        return wrong_type(check.field, check.type, (messages[-1].type_name,))
    if not since_s or check.messages > 1:
        messages = messages[-count:]
    try:
        found = [field_at(message.value, check.path) for message in messages]
    except FieldMissingError as error:
        return missed(reason_of(error))
    if check.changes is not None:
        return _changes(check, found)
    wrong = [value for value in found if not _complies(check, value)]
    if not wrong or (since_s and check.messages == 1 and len(wrong) < len(found)):
        return MET
    return missed(say("{path} of {topic} is {value}", path=check.path, topic=check.field, value=shown(wrong[-1])))


def _changes(check: FieldCheck, found: list[Any]) -> Observation:
    if any(differs(found[0], value, None) for value in found[1:]) == check.changes:
        return MET
    path, topic = check.path, check.field
    if check.changes:
        return missed(say("{path} of {topic} is always {value}", path=path, topic=topic, value=shown(found[0])))
    return missed(say("{path} of {topic} changes", path=path, topic=topic))


def _complies(check: FieldCheck, value: Any) -> bool:  # noqa: ANN401 - any field
    if check.between is not None:
        low, high = check.between
        return isinstance(value, (int, float)) and low <= value <= high
    if check.matches is not None:
        return re.search(check.matches, shown(value)) is not None
    return not differs(check.equals, value, check.tolerance)


def log(check: LogCheck, evidence: Evidence, since_s: float) -> Observation:
    lines = evidence.lines(check.log, since_s)
    fitting = [line for line in lines if re.search(check.matches, line.text)]
    right = [line for line in fitting if check.level in (None, line.severity.value)]
    if len(right) >= check.lines:
        return MET
    if fitting and not right:
        words = say("{node} logs it as {found}, not as {wanted}: {text}", node=check.log,
                    found=fitting[0].severity.value, wanted=check.level, text=fitting[0].text)  # fmt: skip
        return missed(words)
    if right:
        seen = say("{node} logs it fewer than {n} times", node=check.log, n=check.lines)
    elif lines:
        # The first: it is the same in each run.
        seen = say("{node} logs instead: {text}", node=check.log, text=lines[0].text)
    else:
        seen = say("{node} logs nothing", node=check.log)
    return missed(seen, dead_nodes(evidence))


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
