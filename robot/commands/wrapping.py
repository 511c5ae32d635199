"""What models put around their JSON, taken away where it is sure what was meant.

That is a byte order mark, their thoughts up to </think>, one fence of Markdown and the words before
and after it, and curly quotes. Each character is replaced by another one, so that every place in
the text stays what it was.
"""

from __future__ import annotations

import re

from robot.commands.json_places import JsonError, PlacedJson, line_column, read
from robot.commands.problems import CommandError, Problem
from robot.limits import OF_COMMANDS

THINK, THOUGHT = "<think>", "</think>"
_FENCE = re.compile(r"(```|~~~)[A-Za-z0-9]*(?=[\s{\[])")
_PROSE = re.compile(r"(?!\s*[\[\"'])(?!.*</?think>)[^{}]*", re.DOTALL)
"""Words that neither are JSON nor hold an object of it."""
_VISIBLE = re.compile(r"[^\n]")
_STRAIGHT = str.maketrans(dict.fromkeys("“”„‟", '"'))
_UNITS = {name: limits.unit for name, limits in OF_COMMANDS.items()}


def read_answer(text: str) -> PlacedJson:
    """Parse the JSON of an answer, whatever is around it; raises `CommandError`."""
    inner = unwrapped(text)
    try:
        _refuse_thoughts_alone(text, inner)
        return _read(inner)
    except JsonError as error:
        place = line_column(text, error.offset)
        raise CommandError([Problem.of(error.code, error.path, place, **error.details)]) from None


def _refuse_thoughts_alone(text: str, inner: str) -> None:
    left = inner.lstrip()
    at = len(inner) - len(left)
    if left.startswith(THINK) and THOUGHT not in left:
        raise JsonError("thoughts", at)
    if not left and (visible := text.strip("\ufeff \t\r\n")):
        raise JsonError("thoughts" if THOUGHT in visible else "words", text.index(visible))


def _read(inner: str) -> PlacedJson:
    try:
        return read(inner, _UNITS)
    except JsonError:
        straight = straightened(inner)
        if straight == inner:
            raise
        try:
            return read(straight, _UNITS)
        except JsonError:
            # Not sure, then: what is named is the quote.
            pass
        raise


def unwrapped(text: str, *, whole: bool = True) -> str:
    """Return an answer with blanks for what is around its JSON; if not `whole`, of its beginning.

    A fence that is not closed belongs to an answer that was cut off, and stays.
    """
    text = f" {text[1:]}" if text.startswith("\ufeff") else text
    text = _without_thoughts(text)
    opening = _FENCE.search(text)
    if opening is None or not _PROSE.fullmatch(text, 0, opening.start()):
        return text
    # The last one: strings of the JSON may have fences of their own.
    end = text.rfind(opening[1], opening.end())
    if end != -1 and _PROSE.fullmatch(text, end + len(opening[1])):
        return _blanked(text[: opening.end()]) + text[opening.end() : end] + _blanked(text[end:])
    return text if whole else _blanked(text[: opening.end()]) + text[opening.end() :]


def _without_thoughts(text: str) -> str:
    """Blank thoughts, whose beginning some servers leave out since it stands in their prompt.

    An answer that begins with its JSON has no thoughts before it.
    """
    thoughts, end, rest = text.partition(THOUGHT)
    begun = thoughts.lstrip()
    is_sure = begun[:1] not in tuple("{[\"'`~") and THINK not in begun.removeprefix(THINK)
    return _blanked(thoughts + end) + rest if end and is_sure else text


def straightened(text: str) -> str:
    """Return a text with straight quotes where it has none but curly ones."""
    return text if '"' in text else text.translate(_STRAIGHT)


def _blanked(text: str) -> str:
    return _VISIBLE.sub(" ", text)
