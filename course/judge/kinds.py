"""The kinds of checks in one table: how each is judged, what it needs to see, and what it expects, in a sentence."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from course.judge import acting, looking
from course.judge.evidence import MET, Evidence, Observation, missed
from course.judge.fields import shown
from course.judge.functions import python
from course.judge.looking import nobody_subscribes
from graph.data import TopicRow
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.requests import Publish
from launcher.profile.steps.checks import KINDS as MODELS
from launcher.profile.steps.checks import (
    ActionCheck,
    CheckDocument,
    FieldCheck,
    LogCheck,
    NodeCheck,
    PublishCheck,
    PythonCheck,
    TopicCheck,
    kind_of,
)
from text.i18n import N_
from text.sentences import InLanguages, reason_of, say

SUBSCRIBED_S = 3.0
"""How long the judge waits for its own subscriptions before it publishes."""


class Kind(NamedTuple):
    """One kind of check."""

    template: Callable[[Any], str] | str
    """That of the sentence that says what a check expects; its names are those of the check's fields."""
    look: Callable[[Any, Evidence, float], Observation | None] | None = None
    """Look at what has come since a time; 0: since the nodes were started."""
    act: Callable[[Any, Evidence], Any] | None = None
    """Do something, and wait for what comes of it, for a time of its own."""
    topics: Callable[[Any], set[str]] = lambda _check: set()
    """The topics whose messages it needs to see."""


async def judged(check: CheckDocument, evidence: Evidence, since_s: float = 0.0) -> Observation:
    """Judge a check, for as long as it may take."""
    kind = _kind(check)
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


def _kind(check: CheckDocument) -> Kind:
    return KINDS[str(kind_of(check))]


def topics_of(check: CheckDocument) -> set[str]:
    """Return the topics whose messages a check needs to see."""
    return _kind(check).topics(check)


async def _published(check: PublishCheck, evidence: Evidence) -> Observation:
    """Publish, and judge what follows; publish once more if it may not have been answered at all.

    A publisher that has not discovered the judge's subscription yet answers in vain, and nobody
    but that publisher knows.
    """
    await evidence.holds(lambda: all(row.measured for row in _published_rows(check, evidence)), SUBSCRIBED_S)
    began_s = time.time()
    observation = await _followed(check, evidence, began_s)
    if not (observation.met or observation.final) and _unanswered(check, evidence, began_s):
        observation = await _followed(check, evidence, time.time())
    return observation


def _published_rows(check: PublishCheck, evidence: Evidence) -> list[TopicRow]:
    """Return the topics that are to follow and that somebody publishes."""
    return [row for name in topics_of(check) if (row := evidence.topic(name)) and row.publishers]


def _unanswered(check: PublishCheck, evidence: Evidence, since_s: float) -> bool:
    """Whether a topic that is published by somebody has carried nothing since then.

    Where a node of the profile publishes the same, what came may have been answers to that.
    """
    asked = evidence.topic(check.publish)
    nodes = {f"/{name}" for name in evidence.nodes}
    if asked is not None and any(end.node in nodes for end in asked.published_by):
        return True
    return any(not evidence.messages(row.name, since_s) for row in _published_rows(check, evidence))


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
    try:
        heard = await evidence.ask(Publish(check.publish, check.type, check.message))
    except (FieldError, UnknownTypeError):
        raise
    except Exception as error:  # noqa: BLE001 - the graph refuses it
        return missed(reason_of(error))
    if heard:
        return MET
    row = evidence.topic(check.publish)
    types = tuple(dict.fromkeys(end.type_name for end in row.subscribed_by)) if row else ()
    if types and types != (check.type,):
        words = say("{topic} is subscribed to as {found}, not as {wanted}", topic=check.publish,
                    found=", ".join(types), wanted=check.type)  # fmt: skip
        return missed(words)
    if not row or not row.subscribed_by:
        return nobody_subscribes(evidence, check.publish)
    end = row.subscribed_by[0]
    words = say("{node} subscribes to {topic} in vain; its QoS: {reliability}, {durability}", node=end.node,
                topic=check.publish, reliability=end.reliability, durability=end.durability)  # fmt: skip
    return missed(words, say("The QoS of a subscription must not ask for more than publishers offer."))


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
    template = _kind(check).template
    return say(template if isinstance(template, str) else template(check), **about)


def _shown(value: object) -> str:
    if isinstance(value, tuple) and len(value) == 2:
        return f"{shown(value[0])}…{shown(value[1])}"
    return shown(value) if value is not None else "-"


def _of_topic(check: TopicCheck) -> str:
    if check.silent is not None:
        return N_("nothing comes on {topic}")
    if check.only is not None:
        return N_("nobody but {only} publishes {topic}") if check.only else N_("nobody publishes {topic}")
    if check.rate is not None:
        return N_("{topic} comes {rate} times a second")
    return N_("{topic} is published as {type}")


def _of_field(check: FieldCheck) -> str:
    if check.between is not None:
        return N_("{path} of {field} is between {low} and {high}")
    if check.matches is not None:
        return N_("{path} of {field} has {matches}")
    if check.changes is None:
        return N_("{path} of {field} is {equals}")
    if check.changes:
        return N_("{path} of {field} differs from message to message")
    return N_("{path} of {field} stays the same")


def _of_action(check: ActionCheck) -> str:
    if not check.accepted:
        return N_("{action} refuses the goal {goal}")
    if check.cancel:
        return N_("{action} lets the goal {goal} be cancelled")
    if check.result:
        return N_("{action} carries out the goal {goal}, with the result {result}")
    return N_("{action} takes the goal {goal}")


def _of_node(check: NodeCheck) -> str:
    if check.ends is not None:
        return N_("{node} ends on Ctrl-C with exit code {ends}")
    return N_("the node {node} is in the graph")


def _measured(check: TopicCheck) -> set[str]:
    return {check.topic} if check.rate or check.silent else set()


def _following(check: PublishCheck) -> set[str]:
    return {topic for follows in check.then for topic in topics_of(follows)}


KINDS: Mapping[str, Kind] = {
    "node": Kind(_of_node, act=acting.node),
    "topic": Kind(_of_topic, looking.topic, topics=_measured),
    "subscription": Kind(N_("{by} subscribes to {subscription}"), looking.subscription),
    "field": Kind(_of_field, looking.field, topics=lambda check: {check.field}),
    "service": Kind(N_("{service}, asked {request}, answers {response}"), act=acting.service),
    "action": Kind(_of_action, act=acting.action),
    "publish": Kind(N_("when {message} is published on {publish}: {then}"), act=_published, topics=_following),
    "parameter": Kind(N_("{of} has the parameter {parameter}"), act=acting.parameter),
    "log": Kind(N_("{log} logs {matches}"), looking.log),
    "python": Kind(N_("a check of this lesson: {python}"), topics=lambda check: set(check.topics)),
}
assert set(KINDS) == set(MODELS)
