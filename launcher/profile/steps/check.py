"""Checks across the steps of a profile: ids, needs, names of nodes, what `${...}` refers to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launcher.profile.steps.checks import CheckDocument, FieldCheck, LogCheck, NodeCheck, PublishCheck, kind_of
from launcher.profile.steps.draw import draw
from launcher.profile.steps.expressions import ExpressionError, evaluate, expressions
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import place_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from launcher.profile.model import ProfileDocument
    from launcher.profile.problems import Problems
    from launcher.profile.steps.expressions import Drawn
    from launcher.profile.steps.model import ValueDocument
    from text.yaml_tree import Branch, Where

PASSIVE = ("field", "log", "python", "topic")
"""What may stand in `then`: what only looks."""


def check_steps(document: ProfileDocument, nodes: Collection[str], tree: Branch, problems: Problems) -> None:
    """Check the steps and values of a profile with these nodes."""
    _check_values(document.values, tree, problems)
    if problems.found:
        return
    values = draw(document.values, seed=1)
    before: list[str] = []
    for index, step in enumerate(document.steps):
        where: Where = ("steps", index)
        if step.id in before:
            message = say("there is a step {id!r} already", id=step.id)
            problems.add(place_of(tree, (*where, "id")), (*where, "id"), message)
        for number, other in enumerate(step.needs):
            if other not in before:
                here = (*where, "needs", number)
                message = say("no step before this one is called {id!r}", id=other)
                problems.add(place_of(tree, here), here, message, did_you_mean(other, before))
        before.append(step.id)
        _check_checks(step.checks, (*where, "checks"), nodes, tree, problems)
        for here, text in _texts(step.checks, (*where, "checks")):
            _check_text(text, here, values, tree, problems)


def _check_values(values: Mapping[str, ValueDocument], tree: Branch, problems: Problems) -> None:
    for name, value in values.items():
        where = ("values", name)
        if (value.between is None) == (not value.one_of):
            message = say("expected exactly one of between, one_of")
            problems.add(place_of(tree, where), where, message)
        elif value.between is not None and value.between[0] >= value.between[1]:
            message = say("the first number must be the smaller one")
            problems.add(place_of(tree, where), where, message)
        elif not all(isinstance(each, (str, int, float)) for each in value.one_of):
            problems.add(place_of(tree, where), where, say("expected texts or numbers"))


def _check_checks(
    checks: tuple[CheckDocument, ...], above: Where, nodes: Collection[str], tree: Branch, problems: Problems
) -> None:
    for index, check in enumerate(checks):
        where = (*above, index)
        if isinstance(check, LogCheck) or (isinstance(check, NodeCheck) and check.ends is not None):
            kind = str(kind_of(check))
            name = str(getattr(check, kind)).lstrip("/")
            if name not in nodes:
                here = (*where, kind)
                message = say("there is no node {name!r}", name=name)
                problems.add(place_of(tree, here), here, message, did_you_mean(name, nodes))
        if isinstance(check, FieldCheck):
            given = (check.between, check.equals, check.changes, check.matches)
            if sum(each is not None for each in given) != 1:
                message = say("expected exactly one of between, equals, changes, matches")
                problems.add(place_of(tree, where), where, message)
        if isinstance(check, PublishCheck):
            then = (*where, "then")
            for number, follows in enumerate(check.then):
                if kind_of(follows) not in PASSIVE:
                    here = (*then, number)
                    message = say("only these can follow: {kinds}", kinds=", ".join(PASSIVE))
                    problems.add(place_of(tree, here), here, message)
            _check_checks(check.then, then, nodes, tree, problems)


def _texts(value: Any, where: Where) -> Iterator[tuple[Where, str]]:  # noqa: ANN401 - any YAML
    if isinstance(value, CheckDocument):
        value = value.model_dump(by_alias=True)
    if isinstance(value, str):
        yield where, value
    elif isinstance(value, dict):
        for key, inner in value.items():
            if key not in ("look", "what"):
                yield from _texts(inner, (*where, key))
    elif isinstance(value, (list, tuple)):
        for index, inner in enumerate(value):
            yield from _texts(inner, (*where, index))


def _check_text(text: str, where: Where, values: Mapping[str, Drawn], tree: Branch, problems: Problems) -> None:
    try:
        for expression in expressions(text):
            evaluate(expression, values)
    except ExpressionError as error:
        problems.add(place_of(tree, where), where, error.words)
