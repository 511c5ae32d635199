"""Which function judges which kind of check, and what a check expects, in a sentence."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING, Any

from course.judge import calls, gates, in_graph, messages, processes, transforms
from course.judge.evidence import MET, Observation
from course.judge.fields import shown
from course.judge.functions import python
from course.judge.missing import nobody_subscribes
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.requests import Publish
from launcher.profile.steps.checks import (
    KINDS,
    ActionCheck,
    CheckDocument,
    FieldCheck,
    GateCheck,
    LogCheck,
    NoPublisherCheck,
    NothingCheck,
    PublishCheck,
    PythonCheck,
    TransformCheck,
    kind_of,
)
from text.sentences import InLanguages, reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from course.judge.evidence import Evidence

LOOKS: Mapping[str, Callable[[Any, Evidence, float], Observation | None]] = {
    "topic": in_graph.topic,
    "subscription": in_graph.subscription,
    "qos": in_graph.qos,
    "rate": messages.rate,
    "field": messages.field,
    "image": messages.image,
    "nothing": messages.nothing,
    "log": processes.log,
    "transform": transforms.transform,
}
"""Checks that only look, at what has come since a time; 0: since the nodes were started."""
CALLS: Mapping[str, Callable[[Any, Evidence], Any]] = {
    "node": in_graph.node,
    "gate": gates.gate,
    "service": calls.service,
    "action": calls.action,
    "parameter": calls.parameter,
    "ends": processes.ends,
    "no_publisher": in_graph.no_publisher,
}
"""Checks that do something, and wait for what comes of it, or that look for a time of their own."""
SUBSCRIBED_S = 3.0
"""How long the judge waits for its own subscriptions before it publishes."""


async def judged(check: CheckDocument, evidence: Evidence, since_s: float = 0.0) -> Observation:
    """Judge a check, for as long as it may take."""
    kind = str(kind_of(check))
    if isinstance(check, PythonCheck):
        return await python(check, evidence, since_s, check.within)
    if isinstance(check, PublishCheck):
        return await _published(check, evidence)
    if kind in CALLS:
        found: Observation = await CALLS[kind](check, evidence)
        return found
    if isinstance(check, NothingCheck):
        since_s = since_s or time.time()
        return await evidence.until(lambda: messages.nothing(check, evidence, since_s), check.for_s + 1)
    within_s = check.within
    if kind in ("rate", "image"):
        within_s = max(within_s, getattr(check, "over", 2.0) + 2)
    return await evidence.until(lambda: LOOKS[kind](check, evidence, since_s), within_s)


async def _published(check: PublishCheck, evidence: Evidence) -> Observation:
    """Publish, and judge what follows; publish once more if it may not have been answered at all.

    A publisher that has not discovered the judge's subscription yet answers in vain, and nobody
    but that publisher knows.
    """
    await _hears(check, evidence)
    began_s = time.time()
    observation = await _followed(check, evidence, began_s)
    if not (observation.met or observation.final) and _unanswered(check, evidence, began_s):
        observation = await _followed(check, evidence, time.time())
    return observation


def _unanswered(check: PublishCheck, evidence: Evidence, since_s: float) -> bool:
    """Whether a topic that is published by somebody has carried nothing since then.

    Where a node of the profile publishes the same, what came may have been answers to that.
    """
    asked = evidence.topic(check.publish)
    nodes = {f"/{name}" for name in evidence.nodes}
    if asked is not None and any(end.node in nodes for end in asked.published_by):
        return True
    topics = {topic for follows in check.then for topic in topics_of(follows)}
    rows = [row for name in topics if (row := evidence.topic(name)) and row.publishers]
    return any(not evidence.messages(row.name, since_s) for row in rows)


async def _followed(check: PublishCheck, evidence: Evidence, began_s: float) -> Observation:
    """Publish as often as it is said, and judge what has followed since the time it began."""
    for number in range(check.repeat):
        if number:
            await evidence.let_pass(check.every)
        observation = await _sent(check, evidence)
        if not observation.met:
            return observation
    for follows in check.then:
        observation = await judged(follows, evidence, began_s)
        if not observation.met:
            return observation
    return MET


async def _sent(check: PublishCheck, evidence: Evidence) -> Observation:
    import asyncio

    sending = evidence.observer.ask(Publish(check.publish, check.type, check.message))
    try:
        heard = await asyncio.wrap_future(sending)
    except (FieldError, UnknownTypeError):
        raise
    except Exception as error:  # noqa: BLE001 - the graph refuses it
        return Observation(met=False, seen=reason_of(error))
    if heard:
        return MET
    row = evidence.topic(check.publish)
    types = tuple(dict.fromkeys(end.type_name for end in row.subscribed_by)) if row else ()
    if types and types != (check.type,):
        return Observation(
            met=False,
            seen=say(
                "{topic} is subscribed to as {found}, not as {wanted}",
                topic=check.publish,
                found=", ".join(types),
                wanted=check.type,
            ),
        )
    if row and row.subscribed_by:
        end = row.subscribed_by[0]
        return Observation(
            met=False,
            seen=say(
                "{node} subscribes to {topic} in vain; its QoS: {reliability}, {durability}",
                node=end.node,
                topic=check.publish,
                reliability=end.reliability,
                durability=end.durability,
            ),
            look=say("The QoS of a subscription must not ask for more than publishers offer."),
        )
    return nobody_subscribes(evidence, check.publish)


async def _hears(check: PublishCheck, evidence: Evidence) -> None:
    """Wait until the judge itself is subscribed to what is to follow."""
    topics = {topic for follows in check.then for topic in topics_of(follows)}

    def hears() -> Observation | None:
        rows = [row for topic in topics if (row := evidence.topic(topic)) and row.publishers]
        return MET if all(row.measured for row in rows) else None

    await evidence.until(hears, SUBSCRIBED_S)


def topics_of(check: CheckDocument) -> set[str]:
    """Return the topics whose messages a check needs to see."""
    kind = kind_of(check)
    if isinstance(check, PublishCheck):
        return {topic for follows in check.then for topic in topics_of(follows)}
    if isinstance(check, PythonCheck):
        return set(check.topics)
    if isinstance(check, TransformCheck):
        return set(transforms.TOPICS)
    if isinstance(check, GateCheck):
        return {check.gate, check.distance}
    return {getattr(check, kind)} if kind in ("rate", "field", "image", "nothing") else set()


def expected(check: CheckDocument) -> str:
    """Return what a check expects, in a sentence."""
    if check.what:
        return InLanguages(check.what)
    if isinstance(check, FieldCheck):
        return _expected_field(check)
    if isinstance(check, PublishCheck):
        return say(
            "when {message} is published on {topic}: {then}",
            message=shown(check.message),
            topic=check.publish,
            then=expected(check.then[0]),
        )
    kind = str(kind_of(check))
    about: dict[str, Any] = {
        name.removesuffix("_nodes").removesuffix("_node"): _shown(value)
        for name, value in check
        if name not in ("look", "what", "within")
    }
    if isinstance(check, ActionCheck):
        return say(_expected_end(check), **about)
    if isinstance(check, NoPublisherCheck) and check.except_nodes:
        names = check.except_nodes
        about["except"] = names if isinstance(names, str) else ", ".join(names)
        return say("nobody but {except} publishes {no_publisher}", **about)
    if isinstance(check, LogCheck):
        about["matches"] = _plainly(check.matches)
    if isinstance(check, PythonCheck):
        about["python"] = check.python.partition(":")[2].replace("_", " ")
    return say(WORDS[kind], **about)


def _expected_end(check: ActionCheck) -> str:
    """Return the template of what an action must do with a goal."""
    if not check.accepted:
        return say("{action} refuses the goal {goal}").template
    if check.cancel:
        return say("{action} lets the goal {goal} be cancelled").template
    if check.result:
        return say("{action} carries out the goal {goal}, with the result {result}").template
    return WORDS["action"]


def _plainly(pattern: str) -> str:
    """Return a regular expression as a learner reads it: without what only makes it one."""
    return re.sub(r"\\([^A-Za-z0-9])", r"\1", pattern)


def _shown(value: object) -> str:
    if isinstance(value, tuple) and len(value) == 2:
        return f"{shown(value[0])}…{shown(value[1])}"
    return shown(value) if value is not None else "-"


def _expected_field(check: FieldCheck) -> str:
    words: dict[str, Any] = {"path": check.path, "topic": check.field}
    if check.between is not None:
        low, high = map(shown, check.between)
        return say("{path} of {topic} is between {low} and {high}", low=low, high=high, **words)
    if check.matches is not None:
        return say("{path} of {topic} has {pattern}", pattern=_plainly(check.matches), **words)
    if check.changes is not None:
        template = say("{path} of {topic} differs from message to message").template
        return say(template if check.changes else say("{path} of {topic} stays the same").template, **words)
    return say("{path} of {topic} is {value}", value=shown(check.equals), **words)


WORDS = {
    "node": say("the node {node} is in the graph").template,
    "topic": say("{topic} is published as {type}").template,
    "subscription": say("{by} subscribes to {subscription}").template,
    "image": say("{image} carries pictures").template,
    "rate": say("{rate} comes {between} times a second").template,
    "qos": say("the QoS of {qos} is {reliability}, {durability}").template,
    "service": say("{service}, asked {request}, answers {response}").template,
    "action": say("{action} takes the goal {goal}").template,
    "nothing": say("nothing comes on {nothing}").template,
    "parameter": say("{of} has the parameter {parameter}").template,
    "transform": say("{transform} is known to tf").template,
    "log": say("{log} logs {matches}").template,
    "ends": say("{ends} ends on Ctrl-C with exit code {code}").template,
    "no_publisher": say("nobody publishes {no_publisher}").template,
    "gate": say("only {from} publishes {gate}, and it stops before an obstacle").template,
    "python": say("a check of this lesson: {python}").template,
}
assert {*WORDS, "field", "publish"} == set(KINDS)
