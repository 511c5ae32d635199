"""The system prompt: a text file that a learner edits, read again for each question."""

from __future__ import annotations

from pathlib import Path

from brain.faults import FaultKind, ModelError
from text.os_words import os_reason
from text.sentences import say

PROMPTS = Path(__file__).resolve().parents[1] / "profiles" / "prompts"
LONGEST = 32 * 1024
"""Bytes."""


def prompt_file(given: str, name: str, language: str) -> Path:
    """Return the user's own file if one is given, else Deck's of this name and language."""
    if given:
        return Path(given).expanduser()
    own = PROMPTS / f"{name}.{language}.md"
    return own if own.is_file() else PROMPTS / f"{name}.md"


def read_prompt(path: Path) -> str:
    """Return the text of a prompt.

    Raises:
        ModelError: if it cannot be read, or is longer than `LONGEST`.
    """
    try:
        with path.open("rb") as file:
            data = file.read(LONGEST + 1)
    except OSError as error:
        reason = os_reason(error)
        words = say("the prompt {path} cannot be read: {reason}", path=str(path), reason=reason)
        raise ModelError(FaultKind.PROMPT, words) from None
    if len(data) > LONGEST:
        words = say("the prompt {path} is longer than {limit} KiB", path=str(path), limit=LONGEST // 1024)
        raise ModelError(FaultKind.PROMPT, words)
    return data.decode("utf-8", "replace")
