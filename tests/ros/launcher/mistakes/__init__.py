"""The usual mistakes of beginners, each in a small program, and the sentence that it gets."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from tests.ros.launcher.mistakes import programs

TABLE: dict[str, dict[str, dict[str, Any]]] = yaml.safe_load(
    Path(__file__).with_name("mistakes.yaml").read_text(encoding="utf-8")
)
"""Group, name, and what is wrong in which program."""
SENTENCES = Path(__file__).with_name("sentences.txt")
"""Of each mistake a line: its name, and the English sentence."""


def program(text: str = "", swap: list[list[str]] | None = None, **around: Any) -> str:
    """Return the program that a row of the table describes."""
    made = text.replace("{HEAD}", programs.HEAD)
    for kind, given in around.items():
        build = getattr(programs, kind)
        made = build(**given) if isinstance(given, dict) else build(given)
    for before, after, *times in swap or ():
        made = made.replace(before, after, *map(int, times))
    return made


MISTAKES = {name: program(**row) for group in TABLE.values() for name, row in group.items()}
"""Name to program."""
ONE_IN_EACH = 5
GATE = tuple(name for group in TABLE.values() for name in list(group)[::ONE_IN_EACH])
"""Some sixty of all groups; the others are tried at night."""


def sentences() -> dict[str, str]:
    """Return the sentence of each mistake, in English."""
    lines = SENTENCES.read_text().splitlines() if SENTENCES.exists() else []
    return dict(line.split(" | ", 1) for line in lines)


def write(found: dict[str, str]) -> None:
    SENTENCES.write_text("".join(f"{name} | {words}\n" for name, words in found.items()))
