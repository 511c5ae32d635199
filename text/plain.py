"""Sanitizing text from outside, so that it can neither control a terminal nor hide in it.

Characters that are invisible, or that change how others are displayed, are each replaced by one
visible character of one cell: control characters by their pictures (U+2400 and following), all
others by U+FFFD. These are

- the control characters C0, DEL and C1, and the line and paragraph separators,
- characters that change the writing direction or take no room: U+200B, U+2060, U+FEFF, fillers,
- surrogates, private use characters and noncharacters,
- joiners, variation selectors and tags, except where a script or an emoji needs them.
"""

from __future__ import annotations

import re
from string import Formatter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

REPLACEMENT = "\N{REPLACEMENT CHARACTER}"

_SUSPECT = (
    "\x00-\x1f\x7f-\x9f\xad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180b-\u180f\u200b-\u200f"
    "\u2028-\u202e\u2060-\u206f\u3164\ud800-\uf8ff\ufdd0-\ufdef\ufe00-\ufe0f\ufeff\uffa0"
    "\ufff0-\ufffb\ufffe\uffff\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e0fff"
    "\U000f0000-\U0010ffff"
) + "".join(f"{chr(plane + 0xFFFE)}{chr(plane + 0xFFFF)}" for plane in range(0x10000, 0xE0000, 0x10000))
_EMOJI = (
    "\xa9\xae\u203c\u2049\u2122\u2139\u2190-\u21ff\u2300-\u23ff\u24c2\u25a0-\u27bf\u2900-\u297f"
    "\u2b00-\u2bff\u3030\u303d\u3297\u3299\U0001f000-\U0001faff"
)
_JOINING = (
    "\u0620-\u065f\u066e-\u06d3\u06d5-\u06dc\u06de-\u06ff\u0710-\u07fa\u0840-\u0fff\u1000-\u109f"
    "\u1780-\u17b3\u17b6-\u17d3\u1820-\u18aa\u1b00-\u1bff"
)
"""Letters and marks of scripts with joining letters: Arabic, Syriac, Indic, Mongolian..."""
_VIRAMA = "\u094d\u09cd\u0a4d\u0acd\u0b4d\u0bcd\u0c4d\u0ccd\u0d4d\u0dca"
"""After these a joiner may end a word."""
_IDEOGRAPH = "\u3400-\u4dbf\u4e00-\u9fff\uf900-\ufaff\U00020000-\U0003fffd"
_NEEDED = "|".join(
    (
        # The flags of England, Scotland and Wales.
        "\U0001f3f4[\U000e0030-\U000e0039\U000e0061-\U000e007a]{3,6}\U000e007f",
        f"[{_EMOJI}][\ufe0e\ufe0f]?(?:\u200d[{_EMOJI}]\ufe0f?)*",
        "[0-9#*]\ufe0f",
        f"[{_JOINING}][\u200c\u200d](?=[{_JOINING}])|[{_VIRAMA}][\u200c\u200d]",
        "[\u1820-\u18aa][\u180b-\u180e]",
        f"[{_IDEOGRAPH}][\ufe00-\ufe02\U000e0100-\U000e01ef]",
    )
)
_PRINTABLE = re.compile("[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u3164\ufe00-\ufe0f\uffa0\U000e0100-\U000e01ef]")
"""The suspects that `str.isprintable`, the fastest check, takes for printable."""
_HIDDEN = re.compile(f"{_NEEDED}|([{_SUSPECT}])")


def plain(text: str, limit: int | None = None) -> str:
    """Return `text` as one line of the same length, without hidden or control characters.

    With a `limit`, only that many characters of the text are used.
    """
    if limit is not None:
        text = text[:limit]
    return replaced(text, _picture)


def plain_lines(text: str) -> str:
    """Return `text` with its line breaks, each line sanitized by `plain`."""
    return replaced(text, lambda character: "\n" if character == "\n" else _picture(character))


def plain_layout(text: str) -> str:
    """Return `text` with its line breaks and tabs, all else sanitized by `plain`."""
    return replaced(text, lambda character: character if character in "\n\t" else _picture(character))


def is_plain(text: str) -> bool:
    """Return whether `plain` leaves this text unchanged."""
    return plain(text) == text


def replaced(text: str, instead: Callable[[str], str]) -> str:
    """Return `text` with each unsafe character replaced by the result of `instead`."""
    if text.isprintable() and (text.isascii() or _PRINTABLE.search(text) is None):
        return text
    return _HIDDEN.sub(lambda found: instead(found[1]) if found[1] else found[0], text)


def filled(template: str, values: Mapping[str, object]) -> str:
    """Fill a template of ours with values from anywhere, like `str.format`."""
    if not values:
        return template
    return _FILLING.vformat(template, (), values)


class _Filling(Formatter):
    def format_field(self, value: object, format_spec: str) -> str:
        """Sanitize the formatted value, whatever format the template asks for."""
        return plain(format(value, format_spec))


_FILLING = _Filling()


def _picture(character: str) -> str:
    code = ord(character)
    if code < 0x20:
        return chr(0x2400 + code)
    return "\N{SYMBOL FOR DELETE}" if code == 0x7F else REPLACEMENT
