"""What models put around their JSON, taken away where it is sure what was meant.

That is a byte order mark, their thoughts in <think>, a fence of Markdown, and curly quotes. Each
character is replaced by another one, so that every place in the text stays what it was.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robot.commands.json_places import JsonError, read

if TYPE_CHECKING:
    from robot.commands.json_places import PlacedJson

_THOUGHTS = re.compile(r"\s*<think>.*?</think>", re.DOTALL)
_FENCE = re.compile(r"\s*(```|~~~)[A-Za-z0-9]*(?=[\s{\[])")
_FENCE_BEGUN = re.compile(r"\s*(?:(?:```|~~~)[A-Za-z0-9]*(?=[\s{\[]|\Z)|(?:`{1,2}|~{1,2})\Z)")
_FENCE_END = re.compile(r"(```|~~~)\s*\Z")
_VISIBLE = re.compile(r"\S")
_STRAIGHT = str.maketrans(dict.fromkeys("“”„‟", '"'))


def read_answer(text: str) -> PlacedJson:
    """Parse the JSON of an answer, whatever is around it; raises `JsonError`."""
    inner = unwrapped(text)
    try:
        return read(inner)
    except JsonError:
        straight = straightened(inner)
        if straight == inner:
            raise
        try:
            return read(straight)
        except JsonError:
            # Not sure, then: what is told is the quote.
            pass
        raise


def unwrapped(text: str, *, whole: bool = True) -> str:
    """Return an answer with blanks for what is around its JSON; if not `whole`, of its beginning.

    A fence that is not closed belongs to an answer that was cut off, and stays.
    """
    text = f" {text[1:]}" if text.startswith("\ufeff") else text
    if thoughts := _THOUGHTS.match(text):
        text = _blanked(text, thoughts)
    opening, end = _FENCE.match(text), _FENCE_END.search(text)
    if opening and end and opening[1] == end[1] and end.start() >= opening.end():
        return _blanked(_blanked(text, end), opening)
    begun = None if whole else _FENCE_BEGUN.match(text)
    return _blanked(text, begun) if begun else text


def straightened(text: str) -> str:
    """Return a text with straight quotes where it has none but curly ones."""
    return text if '"' in text else text.translate(_STRAIGHT)


def _blanked(text: str, found: re.Match[str]) -> str:
    return text[: found.start()] + _VISIBLE.sub(" ", found.group()) + text[found.end() :]
