"""What Fast DDS prints of itself, told from what the processes under test say."""

from __future__ import annotations

_PORT_TAKEN = "open_and_lock_file failed"
"""Two participants of the machine made the same port at the same moment; one takes the next."""


def own_words(text: str) -> str:
    """The text of a process without such lines."""
    return "".join(line for line in text.splitlines(keepends=True) if _PORT_TAKEN not in line)
