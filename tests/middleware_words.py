"""What Fast DDS prints of itself, told from what the processes under test say."""

from __future__ import annotations

from launcher.logs.lines import NEXT_PORT


def own_words(text: str) -> str:
    """The text of a process without such lines."""
    return "".join(line for line in text.splitlines(keepends=True) if NEXT_PORT not in line)
