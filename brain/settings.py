"""Which model to ask, where, and how much: `llm.yaml` in the user's configuration folder.

`$XDG_CONFIG_HOME/deck/llm.yaml`, by default under `~/.config`::

    base_url: http://127.0.0.1:8080/v1
    model: qwen3-1.7b
    key_env: OPENAI_API_KEY

The environment goes before the file: DECK_LLM_BASE_URL, DECK_LLM_MODEL, DECK_LLM_VISION_MODEL, and
DECK_LLM_KEY for the key itself. The key has no field of its own on purpose: it would end in a
repository one day.
"""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any
from urllib.parse import urlsplit

from platformdirs import user_config_path
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import PydanticCustomError

from brain.faults import FaultKind, ModelError, not_set_up
from text.os_words import os_reason
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_faults import YamlError
from text.yaml_tree import Rules, field_name, mapping, place_of, plain, read

if TYPE_CHECKING:
    from collections.abc import Mapping

    from text.sentences import Words
    from text.yaml_tree import Branch, Where

FILE = "llm.yaml"
FROM_ENVIRONMENT = {
    "DECK_LLM_BASE_URL": "base_url",
    "DECK_LLM_MODEL": "model",
    "DECK_LLM_VISION_MODEL": "vision_model",
}
KEY_VARIABLE = "DECK_LLM_KEY"
"""Holds the key where no other variable is named."""
CLIENT = "openai"
"""The library that speaks to the server."""
_RULES = Rules(shares=False, longest=64 * 1024, deepest=8)


def _url(value: str) -> str:
    try:
        parts = urlsplit(value)
        bad = parts.scheme not in ("http", "https") or not parts.hostname or parts.port == 0
    except ValueError:
        bad = True
    if bad:
        raise PydanticCustomError("url", "not an address")
    if parts.username or parts.password:
        raise PydanticCustomError("url_key", "holds a key")
    return value.rstrip("/")


Name = Annotated[str, Field(min_length=1, max_length=200)]
Url = Annotated[str, AfterValidator(_url)]


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class BudgetSettings(_Section):
    """How much may be asked; what would go beyond it is not sent."""

    calls_per_minute: Annotated[int, Field(ge=1, le=10_000)] = 20
    tokens_per_session: Annotated[int, Field(ge=1)] = 200_000
    """Of all of Deck's nodes and screens together."""


class PriceSettings(_Section):
    """What the server's owner charges, to show what was spent."""

    input_per_million: Annotated[float, Field(ge=0, strict=False)]
    output_per_million: Annotated[float, Field(ge=0, strict=False)]
    currency: Annotated[str, Field(min_length=1, max_length=8)] = "USD"


class ModelSettings(_Section):
    """The contents of `llm.yaml`."""

    base_url: Url
    """Up to and with `/v1`: what the OpenAI client calls by this name."""
    model: Name
    vision_model: Name | None = None
    """Looks at pictures; `model` does where there is none."""
    transcription_model: Name = "whisper-1"
    speech_voice: Name = "alloy"
    realtime_model: Name = "gpt-realtime"
    key_env: Name | None = None
    """Name of the environment variable with the key."""
    key_file: Name | None = None
    """File with the key, which only its owner may read; ~ is the home folder."""
    timeout_s: Annotated[float, Field(gt=0, le=3600, strict=False)] = 60.0
    """For a whole answer."""
    first_token_s: Annotated[float, Field(gt=0, le=3600, strict=False)] = 30.0
    """Until the answer begins."""
    budget: BudgetSettings = BudgetSettings()
    prices: PriceSettings | None = None


def settings_path() -> Path:
    """Return the path of the settings, which need not exist."""
    return user_config_path("deck") / FILE


def load(path: Path | None = None, environ: Mapping[str, str] | None = None) -> ModelSettings | None:
    """Return the user's settings, None if there are none.

    Raises:
        ModelError: if they cannot be used; the words name the file, the line and the fix.
    """
    path = settings_path() if path is None else path
    environ = os.environ if environ is None else environ
    tree = _tree(path)
    given: dict[str, Any] = {} if tree is None else plain(tree)
    variables = {field: name for name, field in FROM_ENVIRONMENT.items() if environ.get(name)}
    given.update({field: environ[name] for field, name in variables.items()})
    if not given:
        return None
    try:
        settings = ModelSettings.model_validate(given)
    except ValidationError as error:
        raise _fault(error, path, tree, variables) from None
    if find_spec(CLIENT) is None:
        raise ModelError(
            FaultKind.SETTINGS,
            say("{package} is not installed", package=CLIENT),
            say("pip install {install}", install="'deck-robot[brain]'"),
        )
    return settings


def required() -> ModelSettings:
    """Return the user's settings.

    Raises:
        ModelError: if there are none, or they cannot be used.
    """
    settings = load()
    if settings is None:
        raise not_set_up()
    return settings


def _tree(path: Path) -> Branch | None:
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    except UnicodeDecodeError:
        raise _bad(say("{path}: is not UTF-8", path=str(path))) from None
    except OSError as error:
        words = say("{path}: cannot be read: {reason}", path=str(path), reason=os_reason(error))
        raise _bad(words) from None
    try:
        tree = read(text, _RULES, str(path))
        return None if tree is None else mapping(tree)
    except YamlError as error:
        raise _bad(_at(str(path), error.line, error.column, error.message)) from None


def _fault(error: ValidationError, path: Path, tree: Branch | None, variables: Mapping[str, str]) -> ModelError:
    """Return the first mistake, with its place: a variable's name, or line and column."""
    first = error.errors(include_url=False, include_context=True)[0]
    where: Where = first["loc"]
    words, fix = _explained(first["type"], where, first.get("ctx", {}))
    variable = variables.get(str(where[0])) if where else None
    if variable:
        return _bad(say("{variable}: {problem}", variable=variable, problem=words), fix)
    place = tree and place_of(tree, where, key=first["type"] == "extra_forbidden")
    problem = say("{field}: {problem}", field=field_name(where), problem=words)
    return _bad(_at(str(path), place.line if place else 1, place.column if place else 1, problem), fix)


def _explained(kind: str, where: Where, context: Mapping[str, Any]) -> tuple[Words, str]:
    """Return what is wrong, and what to write instead."""
    if kind == "extra_forbidden":
        return _unknown(where)
    if kind == "missing":
        return say("is missing"), _example(where[-1])
    if kind in _WORDS:
        return _WORDS[kind], _example("base_url")
    if {"ge", "gt", "le"} & context.keys():
        return say("is out of range"), ""
    for prefix, words in _PREFIXES.items():
        if kind.startswith(prefix):
            return words, ""
    return say("is not valid"), ""


def _unknown(where: Where) -> tuple[Words, str]:
    if where[-1] in ("key", "api_key"):
        words = say("a key does not belong in this file")
        return words, say("write key_env: VARIABLE, or key_file: FILE (of mode 0600)")
    if where[-1] == "speech_model":
        words = say("no server speaks or hears for Deck any more, but for realtime_brain")
        return words, say("take the line out; the node speaking has espeak and piper")
    known = _fields(where)
    words = say("there is no such setting; there are: {known}", known=", ".join(known))
    return words, did_you_mean(str(where[-1]), known)


_WORDS = {"url": say("expected an address"), "url_key": say("an address must hold no key")}
_PREFIXES = {
    "int": say("expected a number"),
    "float": say("expected a number"),
    "string": say("expected a text"),
    "model": say("expected settings, one below the other"),
}
_EXAMPLES: dict[str | int, str] = {
    "base_url": "base_url: http://127.0.0.1:8080/v1",
    "model": "model: qwen3-1.7b",
    "input_per_million": "input_per_million: 0.15",
    "output_per_million": "output_per_million: 0.6",
}


def _example(field: str | int) -> str:
    return say("write for example {example}", example=_EXAMPLES[field])


def _fields(where: Where) -> list[str]:
    sections: dict[str | int, type[BaseModel]] = {"budget": BudgetSettings, "prices": PriceSettings}
    section = sections[where[0]] if len(where) > 1 and where[0] in sections else ModelSettings
    return list(section.model_fields)


def _at(path: str, line: int, column: int, problem: str) -> Words:
    return say("{path}:{line}:{column}: {problem}", path=path, line=line, column=column, problem=problem)


def _bad(words: Words, fix: str = "") -> ModelError:
    return ModelError(FaultKind.SETTINGS, words, fix)
