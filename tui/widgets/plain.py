"""Text from outside made harmless: it may neither steer the terminal nor lie in it."""

from __future__ import annotations

_REPLACEMENT = "\N{REPLACEMENT CHARACTER}"
_PICTURES: dict[int, str] = {code: chr(0x2400 + code) for code in range(0x20)}
_PICTURES[0x7F] = "\N{SYMBOL FOR DELETE}"
_PICTURES.update(dict.fromkeys(range(0x80, 0xA0), _REPLACEMENT))
# Marks that reverse or hide the text around them, and the line ends that terminals take for one.
_PICTURES.update(dict.fromkeys((0x200E, 0x200F, 0x2028, 0x2029, 0xFEFF), _REPLACEMENT))
_PICTURES.update(dict.fromkeys(range(0x202A, 0x202F), _REPLACEMENT))
_PICTURES.update(dict.fromkeys(range(0x2066, 0x206A), _REPLACEMENT))
# Lone surrogates cannot be written to a terminal at all.
_PICTURES.update(dict.fromkeys(range(0xD800, 0xE000), _REPLACEMENT))


def plain(text: str, limit: int | None = None) -> str:
    """One line of `text` with control characters shown as their pictures (U+2400 and on).

    C1 controls, marks that change the direction of writing and lone surrogates become U+FFFD.
    With a `limit`, at most that many characters of the text are looked at.
    """
    if limit is not None:
        text = text[:limit]
    if text.isprintable():
        return text
    return text.translate(_PICTURES)
