"""The usual mistakes of beginners, each in a small program, and the sentence that it gets."""

from __future__ import annotations

from pathlib import Path

from tests.ros.launcher.mistakes import actions, language, messages, nodes

GROUPS: tuple[dict[str, str], ...] = (
    messages.FIELDS,
    messages.SENT,
    nodes.MADE,
    nodes.CREATED,
    nodes.PARAMETERS,
    nodes.CLOCKS,
    nodes.SEEN,
    nodes.LOGGED,
    actions.CLIENTS,
    actions.SERVERS,
    language.IMPORTS,
    language.NAMES,
    language.ATTRIBUTES,
    language.CALLS,
    language.OPERATORS,
    language.VALUES,
    language.SYNTAX,
)
MISTAKES: dict[str, str] = {name: text for group in GROUPS for name, text in group.items()}
"""Name to program."""
SENTENCES = Path(__file__).with_name("sentences.txt")
"""Of each mistake a line with its name, one with the English sentence, one with the Russian."""


def sentences() -> dict[str, tuple[str, str]]:
    """Return the sentences of each mistake, in English and Russian."""
    lines = SENTENCES.read_text().splitlines() if SENTENCES.exists() else []
    return {
        name: (english.strip(), russian.strip())
        for name, english, russian in zip(lines[::3], lines[1::3], lines[2::3], strict=True)
    }


def write(found: dict[str, tuple[str, str]]) -> None:
    """Write down the sentences of each mistake."""
    SENTENCES.write_text("".join(f"{name}\n  {en}\n  {ru}\n" for name, (en, ru) in found.items()))
