"""The kinds of checks in one table: how each is judged, what it needs to see, and what it expects, in a sentence."""

from __future__ import annotations

import asyncio
import re
import time
from typing import TYPE_CHECKING, Any, NamedTuple

from course.judge import acting, looking
from course.judge.evidence import MET, Observation, missed
from course.judge.fields import shown
from course.judge.functions import python
from course.judge.missing import nobody_subscribes
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.requests import Publish
from launcher.profile.steps.checks import KINDS as MODELS
from launcher.profile.steps.checks import FieldCheck, LogCheck, PublishCheck, PythonCheck, TopicCheck, kind_of
from text.sentences import InLanguages, reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from course.judge.evidence import Evidence
    from launcher.profile.steps.checks import ActionCheck, CheckDocument, NodeCheck

SUBSCRIBED_S = 3.0
"""How long the judge waits for its own subscriptions before it publishes."""


class Kind(NamedTuple):
    """One kind of check."""

    template: Callable[[Any], str]
    """The template of the sentence that says what a check expects; its names are those of the check's fields."""
    look: Callable[[Any, Evidence, float], Observation | None] | None = None
    """Look at what has come since a time; 0: since the nodes were started."""
    act: Callable[[Any, Evidence], Any] | None = None
    """Do something, and wait for what comes of it, for a time of its own."""
    topics: Callable[[Any], set[str]] = lambda _check: set()
    """The topics whose messages it needs to see."""


async def judged(check: CheckDocument, evidence: Evidence, since_s: float = 0.0) -> Observation:
    """Judge a check, for as long as it may take."""
    kind = KINDS[str(kind_of(check))]
    if isinstance(check, PythonCheck):
        return await python(check, evidence, since_s)
    if kind.act is not None:
        found: Observation = await kind.act(check, evidence)
        return found
    look, within_s = kind.look, check.within
    assert look is not None, kind
    if isinstance(check, TopicCheck):
        if check.silent is not None or check.only is not None:
            since_s = since_s or time.time()
        within_s = max(within_s, (check.over + 2) if check.rate else 0.0, (check.silent or looking.ABSENT_S) + 1)
    return await evidence.until(lambda: look(check, evidence, since_s), within_s)


def topics_of(check: CheckDocument) -> set[str]:
    """Return the topics whose messages a check needs to see."""
    return KINDS[str(kind_of(check))].topics(check)


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


async def _hears(check: PublishCheck, evidence: Evidence) -> None:
    """Wait until the judge itself is subscribed to what is to follow."""

    def hears() -> Observation | None:
        rows = [row for topic in topics_of(check) if (row := evidence.topic(topic)) and row.publishers]
        return MET if all(row.measured for row in rows) else None

    await evidence.until(hears, SUBSCRIBED_S)


def _unanswered(check: PublishCheck, evidence: Evidence, since_s: float) -> bool:
    """Whether a topic that is published by somebody has carried nothing since then.

    Where a node of the profile publishes the same, what came may have been answers to that.
    """
    asked = evidence.topic(check.publish)
    nodes = {f"/{name}" for name in evidence.nodes}
    if asked is not None and any(end.node in nodes for end in asked.published_by):
        return True
    rows = [row for name in topics_of(check) if (row := evidence.topic(name)) and row.publishers]
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
    sending = evidence.observer.ask(Publish(check.publish, check.type, check.message))
    try:
        heard = await asyncio.wrap_future(sending)
    except (FieldError, UnknownTypeError):
        raise
    except Exception as error:  # noqa: BLE001 - the graph refuses it
        return missed(reason_of(error))
    if heard:
        return MET
    row = evidence.topic(check.publish)
    types = tuple(dict.fromkeys(end.type_name for end in row.subscribed_by)) if row else ()
    if types and types != (check.type,):
        return missed(
            say(
                "{topic} is subscribed to as {found}, not as {wanted}",
                topic=check.publish,
                found=", ".join(types),
                wanted=check.type,
            )
        )
    if not row or not row.subscribed_by:
        return nobody_subscribes(evidence, check.publish)
    end = row.subscribed_by[0]
    return missed(
        say(
            "{node} subscribes to {topic} in vain; its QoS: {reliability}, {durability}",
            node=end.node,
            topic=check.publish,
            reliability=end.reliability,
            durability=end.durability,
        ),
        say("The QoS of a subscription must not ask for more than publishers offer."),
    )


def expected(check: CheckDocument) -> str:
    """Return what a check expects, in a sentence."""
    if check.what:
        return InLanguages(check.what)
    about: dict[str, Any] = {name: _shown(value) for name, value in check if name not in ("look", "what", "within")}
    if isinstance(check, PublishCheck):
        about["then"] = expected(check.then[0])
    if isinstance(check, (LogCheck, FieldCheck)) and check.matches is not None:
        # As a learner reads a regular expression: without what only makes it one.
        about["matches"] = re.sub(r"\\([^A-Za-z0-9])", r"\1", check.matches)
    if isinstance(check, FieldCheck) and check.between is not None:
        about["low"], about["high"] = map(shown, check.between)
    if isinstance(check, TopicCheck) and check.only:
        about["only"] = ", ".join(check.only)
    if isinstance(check, PythonCheck):
        about["python"] = check.python.partition(":")[2].replace("_", " ")
    return say(KINDS[str(kind_of(check))].template(check), **about)


def _shown(value: object) -> str:
    if isinstance(value, tuple) and len(value) == 2:
        return f"{shown(value[0])}…{shown(value[1])}"
    return shown(value) if value is not None else "-"


def _of_topic(check: TopicCheck) -> str:
    if check.silent is not None:
        return say("nothing comes on {topic}").template
    if check.only is not None:
        return (
            say("nobody but {only} publishes {topic}") if check.only else say("nobody publishes {topic}")
        ).template
    if check.rate is not None:
        return say("{topic} comes {rate} times a second").template
    return say("{topic} is published as {type}").template


def _of_field(check: FieldCheck) -> str:
    if check.between is not None:
        return say("{path} of {field} is between {low} and {high}").template
    if check.matches is not None:
        return say("{path} of {field} has {matches}").template
    if check.changes is None:
        return say("{path} of {field} is {equals}").template
    if check.changes:
        return say("{path} of {field} differs from message to message").template
    return say("{path} of {field} stays the same").template


def _of_action(check: ActionCheck) -> str:
    if not check.accepted:
        return say("{action} refuses the goal {goal}").template
    if check.cancel:
        return say("{action} lets the goal {goal} be cancelled").template
    if check.result:
        return say("{action} carries out the goal {goal}, with the result {result}").template
    return say("{action} takes the goal {goal}").template


def _of_node(check: NodeCheck) -> str:
    if check.ends is not None:
        return say("{node} ends on Ctrl-C with exit code {ends}").template
    return say("the node {node} is in the graph").template


def _words(template: str) -> Callable[[CheckDocument], str]:
    return lambda _check: template


KINDS: Mapping[str, Kind] = {
    "node": Kind(_of_node, act=acting.node),
    "topic": Kind(
        _of_topic, looking.topic, topics=lambda check: {check.topic} if check.rate or check.silent else set()
    ),
    "subscription": Kind(_words(say("{by} subscribes to {subscription}").template), looking.subscription),
    "field": Kind(_of_field, looking.field, topics=lambda check: {check.field}),
    "service": Kind(_words(say("{service}, asked {request}, answers {response}").template), act=acting.service),
    "action": Kind(_of_action, act=acting.action),
    "publish": Kind(
        _words(say("when {message} is published on {publish}: {then}").template),
        act=_published,
        topics=lambda check: {topic for follows in check.then for topic in topics_of(follows)},
    ),
    "parameter": Kind(_words(say("{of} has the parameter {parameter}").template), act=acting.parameter),
    "log": Kind(_words(say("{log} logs {matches}").template), looking.log),
    "python": Kind(_words(say("a check of this lesson: {python}").template), topics=lambda check: set(check.topics)),
}
assert set(KINDS) == set(MODELS)
