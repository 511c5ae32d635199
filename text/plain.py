"""Text from outside made harmless: it can neither control a terminal nor hide in it.

What cannot be seen, or changes how its neighbours are seen, is replaced by one visible character
of one cell: control characters by their pictures (U+2400 and on), all else by U+FFFD. That is

- the control characters C0, DEL and C1, and the separators of lines and paragraphs,
- what turns the direction of writing, and what takes no room: U+200B, U+2060, U+FEFF, fillers,
- half characters (surrogates), characters for private use, and those that are none,
- joiners, variation selectors and tags, save where a language or an emoji needs them.
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
) + "".join(
    f"{chr(plane + 0xFFFE)}{chr(plane + 0xFFFF)}" for plane in range(0x10000, 0xE0000, 0x10000)
)
_EMOJI = (
    "\xa9\xae\u203c\u2049\u2122\u2139\u2190-\u21ff\u2300-\u23ff\u24c2\u25a0-\u27bf\u2900-\u297f"
    "\u2b00-\u2bff\u3030\u303d\u3297\u3299\U0001f000-\U0001faff"
)
_JOINING = (
    "\u0620-\u065f\u066e-\u06d3\u06d5-\u06dc\u06de-\u06ff\u0710-\u07fa\u0840-\u0fff\u1000-\u109f"
    "\u1780-\u17b3\u17b6-\u17d3\u1820-\u18aa\u1b00-\u1bff"
)
"""Letters and marks of the scripts whose letters join: Arabic, Syriac, Indic, Mongolian..."""
_VIRAMA = "\u094d\u09cd\u0a4d\u0acd\u0b4d\u0bcd\u0c4d\u0ccd\u0d4d\u0dca"
"""After them a joiner may end a word."""
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
_PRINTABLE = re.compile(
    "[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u3164\ufe00-\ufe0f\uffa0\U000e0100-\U000e01ef]"
)
"""Those suspects that Python calls printable: it is the quickest to ask."""
_HIDDEN = re.compile(f"{_NEEDED}|([{_SUSPECT}])")


def plain(text: str, limit: int | None = None) -> str:
    """Return `text` as one line of as many characters, none of which is hidden or obeyed.

    With a `limit`, at most that many characters of the text are looked at.
    """
    if limit is not None:
        text = text[:limit]
    return replaced(text, _picture)


def plain_lines(text: str) -> str:
    """Return `text` in the lines that it has, each of them plain."""
    return replaced(text, lambda character: "\n" if character == "\n" else _picture(character))


def is_plain(text: str) -> bool:
    """Tell whether `plain` leaves this text as it is."""
    return plain(text) == text


def replaced(text: str, instead: Callable[[str], str]) -> str:
    """Return `text` with `instead` of each character that must not be shown as it stands."""
    if text.isprintable() and (text.isascii() or _PRINTABLE.search(text) is None):
        return text
    return _HIDDEN.sub(lambda found: instead(found[1]) if found[1] else found[0], text)


def filled(template: str, values: Mapping[str, object]) -> str:
    """Return a sentence of ours with values from anywhere in it, in the manner of `str.format`."""
    if not values:
        return template
    return _FILLING.vformat(template, (), values)


class _Filling(Formatter):
    def format_field(self, value: object, format_spec: str) -> str:
        """Make harmless what a value was turned into, however the template wants it written."""
        return plain(format(value, format_spec))


_FILLING = _Filling()


def _picture(character: str) -> str:
    code = ord(character)
    if code < 0x20:
        return chr(0x2400 + code)
    return "\N{SYMBOL FOR DELETE}" if code == 0x7F else REPLACEMENT
