"""From a tree to validated documents; pydantic's errors become problems in plain words."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import replace
from typing import Any, TypeVar

from pydantic import BaseModel, TypeAdapter, ValidationError
from pydantic_core import ErrorDetails

from launcher.consent import AgentRules
from launcher.parts import AsText, Given, marked
from launcher.profile.model import Profile
from launcher.profile.node import Node, Ready
from launcher.profile.reading import Problems
from launcher.profile.steps.checks import KINDS, kind_of
from launcher.profile.steps.model import StepDocument, ValueDocument
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import Branch, Listing, Tree, Where, empty, find, plain

D = TypeVar("D")

WANTED = {
    "string_type": say("text"),
    "int_type": say("a whole number"),
    "float_type": say("a number"),
    "bool_type": say("true or false"),
    "tuple_type": say("a list"),
    "dict_type": say("keys and values"),
    "dataclass_type": say("keys and values"),
    "model_type": say("keys and values"),
}
_DECIMAL_COMMA = re.compile(r"(-?[0-9]+),([0-9]+)")
READERS: dict[type, TypeAdapter[Any]] = {kind: TypeAdapter(kind) for kind in (Profile, Node)}
UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")
MISSING = {"missing": say("`{key}` is missing"), "too_short": say("`{key}` is empty")}
LIMITS = {
    "greater_than": (say("more than {limit}"), "gt"),
    "greater_than_equal": (say("at least {limit}"), "ge"),
    "less_than_equal": (say("at most {limit}"), "le"),
}


def validate(problems: Problems) -> tuple[Profile | None, dict[str, Node]]:
    """Return the profile without its nodes, and the nodes; everything invalid becomes a problem.

    Each node is validated separately, so that a fault in one does not hide faults in another.
    """
    nodes = find(problems.tree, ("nodes",))
    data = _data(problems.tree, Profile)
    if isinstance(nodes, Branch):
        data["nodes"] = {}
    profile = _validated(Profile, data, (), problems)
    valid: dict[str, Node] = {}
    for name, entry in nodes.entries.items() if isinstance(nodes, Branch) else ():
        said = (
            _data(entry.value, Node) if isinstance(entry.value, Branch) or empty(entry.value) else plain(entry.value)
        )
        node = _validated(Node, said, ("nodes", name), problems)
        if node is not None:
            valid[name] = replace(node, name=name)
    return profile, valid


def _data(tree: Tree, model: type) -> dict[str, Any]:
    """Return plain data, omitting keys without a value, with text wherever only text makes sense.

    In `exec: [--x, 0.10]` the value is the text 0.10 as written, and in `lesson: 9` the text 9.
    """
    as_text = marked(model, AsText)
    return {
        key: _as_text(entry.value) if key in as_text else plain(entry.value)
        for key, entry in (tree.entries.items() if isinstance(tree, Branch) else ())
        if not empty(entry.value)
    }


def _as_text(tree: Tree | None) -> Any:  # noqa: ANN401 - whatever stands there
    if isinstance(tree, Branch):
        return {key: _as_text(entry.value) for key, entry in tree.entries.items()}
    if isinstance(tree, Listing):
        return [_as_text(item) for item in tree.items]
    return tree.text if tree is not None and not empty(tree) else None


def _validated(kind: type[D], data: Any, where: Where, problems: Problems) -> D | None:  # noqa: ANN401 - any YAML
    """Return the document; if there are problems, without the keys that cause them.

    So later checks can report other problems in the same run.
    """
    model: Any = kind
    for key in marked(model, Given) if isinstance(data, dict) else ():
        if data.pop(key, None) is not None:
            problems.at((*where, key), *_unknown((*where, key), problems.tree), key=True)
    found: D
    try:
        found = READERS[model].validate_python(data)
    except ValidationError as error:
        faults = error.errors(include_url=False)
    else:
        return found
    for details in faults:
        if not _only_follows(details):
            _add(details, where, problems)
    if not isinstance(data, dict):
        return None
    at_fault = {details["loc"][0] for details in faults if details["loc"]}
    with suppress(ValidationError):
        found = READERS[model].validate_python({k: v for k, v in data.items() if k not in at_fault})
        return found
    return None


def _only_follows(details: ErrorDetails) -> bool:
    """Whether a list counts as empty only since its items are wrong, which is reported itself."""
    return details["type"] == "too_short" and bool(details["input"])


def _add(details: ErrorDetails, above: Where, problems: Problems) -> None:
    where = (*above, *_without_kinds(details["loc"]))
    problems.at(where, *_words(details, where, problems.tree), key=details["type"] in UNKNOWN)


def _without_kinds(where: Where) -> Where:
    """Leave out the kind of check that pydantic puts behind the number of each check."""
    kept = [
        part
        for index, part in enumerate(where)
        if index < 2 or where[index - 2] not in ("checks", "then") or part not in KINDS
    ]
    return tuple(kept)


def _words(details: ErrorDetails, where: Where, tree: Branch) -> tuple[str, str]:
    kind, found, context = details["type"], details["input"], details.get("ctx", {})
    if kind == "deck":
        return context["words"], ""
    if kind in WANTED:
        words = say("expected {wanted}, found {found}", wanted=WANTED[kind], found=described(found))
        return words, _fix(kind, found)
    if kind in LIMITS:
        template, key = LIMITS[kind]
        wanted = say(template, limit=f"{context[key]:g}")
        return say("expected {wanted}, found {found}", wanted=wanted, found=described(found)), ""
    if kind in MISSING:
        return say(MISSING[kind], key=str(where[-1])), ""
    return _words_of_choice(details, where, tree)


def _words_of_choice(details: ErrorDetails, where: Where, tree: Branch) -> tuple[str, str]:
    """Return what is wrong with a key or a value that must be one of several."""
    kind, found = details["type"], details["input"]
    if kind in UNKNOWN:
        return _unknown(where, tree)
    if kind == "union_tag_not_found":
        return say("no kind of check is named here"), _likely_kind(found)
    if kind == "literal_error":
        known = _choices(details["ctx"]["expected"])
        return (
            say("expected one of {known}, found {found}", known=", ".join(known), found=described(found)),
            did_you_mean(str(found), known),
        )
    return details["msg"], ""


def _fix(kind: str, found: object) -> str:
    if kind == "string_type" and isinstance(found, (bool, int, float)):
        return say("put it in quotes")
    if kind == "float_type" and isinstance(found, str):
        comma = _DECIMAL_COMMA.fullmatch(found)
        if comma:
            return say("write a fraction with a point: {mended}", mended=".".join(comma.groups()))
    if kind == "tuple_type" and isinstance(found, str):
        return say("write [{value}]", value=found)
    return ""


def _choices(expected: str) -> list[str]:
    """Split pydantic's "'a', 'b' or 'c'" into its choices."""
    return [word.strip("' ") for word in expected.replace(" or ", ", ").split(",")]


def _likely_kind(check: object) -> str:
    for key in check if isinstance(check, dict) else ():
        hint = did_you_mean(str(key), KINDS)
        if hint:
            return hint
    return say("known: {keys}", keys=", ".join(KINDS))


def _unknown(where: Where, tree: Branch) -> tuple[str, str]:
    model = _model(where[:-1], tree)
    given = marked(model, Given)
    fields = getattr(model, "model_fields" if issubclass(model, BaseModel) else "__dataclass_fields__")
    known = [name for name in fields if name not in given]
    hint = did_you_mean(str(where[-1]), known) or say("known: {keys}", keys=", ".join(known))
    return say("unknown key"), hint


def _model(where: Where, tree: Branch) -> type:
    """Return the model of the mapping at this place."""
    above = where[0] if where else ""
    if above == "nodes":
        return Ready if where[-1] == "ready" else Node
    if above == "steps" and len(where) > 2:
        here = find(tree, where)
        return KINDS[kind_of(None if here is None else plain(here)) or "node"]
    return _BY_KEY.get(above, Profile)


_BY_KEY: dict[str | int, type] = {"agents": AgentRules, "values": ValueDocument, "steps": StepDocument}


def described(value: object) -> str:
    """Describe a value found in a file: `the text 'fast'`, `a list`, `12`."""
    if value is None:
        return say("nothing")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        text = value if len(value) <= 40 else value[:39] + "…"
        return say("the text {text!r}", text=text)
    if isinstance(value, (list, tuple)):
        return say("a list")
    if isinstance(value, dict):
        return say("keys and values")
    return str(value)
