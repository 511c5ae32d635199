"""What serves a language model on this machine, which only `deck model serve` needs."""

from __future__ import annotations

import shlex
import sys
from dataclasses import dataclass
from importlib import metadata
from typing import TYPE_CHECKING

from cli.doctor.finding import ok
from text.i18n import _

if TYPE_CHECKING:
    from cli.doctor.finding import Finding

DISTRIBUTION = "xllamacpp"


@dataclass(frozen=True)
class LlamaFacts:
    """What was found."""

    llama: str | None = None
    """The version of xllamacpp, which has llama.cpp inside; None without it."""
    executable: str = "python"


def collect() -> LlamaFacts:
    try:
        version = metadata.version(DISTRIBUTION)
    except metadata.PackageNotFoundError:
        version = None
    return LlamaFacts(version, sys.executable)


def diagnose(facts: LlamaFacts) -> list[Finding]:
    """Report it; nothing is wrong without it."""
    if facts.llama:
        text = _("llama.cpp (xllamacpp {version}): `deck model serve` works")
        return [ok("model.llama", text.format(version=facts.llama))]
    text = _("no llama.cpp; only `deck model serve` needs it: {python} -m pip install xllamacpp")
    return [ok("model.llama", text.format(python=shlex.quote(facts.executable)))]
