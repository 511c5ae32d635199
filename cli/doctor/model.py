"""The language model: whether one is set up, without asking it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from brain.faults import ModelError
from brain.key import key_of
from brain.settings import load
from cli.doctor.finding import ok, warn
from text.i18n import _, localized

if TYPE_CHECKING:
    from brain.settings import ModelSettings
    from cli.doctor.finding import Finding


@dataclass(frozen=True)
class ModelFacts:
    """The user's settings, or what is wrong with them."""

    settings: ModelSettings | None = None
    fault: ModelError | None = None


def collect() -> ModelFacts:
    try:
        settings = load()
        if settings is not None:
            key_of(settings)
    except ModelError as fault:
        return ModelFacts(fault=fault)
    return ModelFacts(settings)


def diagnose(facts: ModelFacts) -> list[Finding]:
    """Report what is set up; without a model all lessons run as well."""
    if facts.fault is not None:
        text = _("language model: {problem}").format(problem=localized(facts.fault.words))
        return [warn("model", text, localized(facts.fault.fix))]
    if facts.settings is None:
        return [ok("model", _("language model: none is set up, ai_brain follows its rules"))]
    text = _("language model: {model} at {url} (deck doctor llm tries it)")
    return [ok("model", text.format(model=facts.settings.model, url=facts.settings.base_url))]
