"""The parser of what the terminal sends: Textual's, but nothing makes it fail or swallow a key.

Alt with a letter is a key as soon as it has come. A terminal sends it as ESC and the letter;
Textual waits 0.1 s for more of a sequence, and if another one begins meanwhile, it takes the first
for `^` and the bare letter: a held Alt+V would open the viewer, which is on `v`.

A key of the kitty keyboard protocol is read in every form, also with its alternates and the type of
the event, which Textual does not ask for, but a program that has crashed may have left on. Textual
fails at them, and at numbers that are no character. With Ctrl or Alt a letter of another layout is
the key that it is on. Source: sw.kovidgoyal.net/kitty/keyboard-protocol.

A whole sequence that nobody knows is dropped. Textual would take the keys behind it for a part.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from textual._ansi_sequences import ANSI_SEQUENCES_KEYS
from textual._xterm_parser import XTermParser
from textual.events import Key
from textual.keys import Keys

from tui.actions.layouts import LATIN_OF

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from textual.message import Message

ESC = "\x1b"
LONGER = frozenset("[OPX]^_") | {ESC}
"""What follows ESC in sequences of more than two characters. Source: ECMA-48, 5.3 and 8.3."""
_WHOLE = re.compile(r"\x1b\[[ -?]*[@-~]")
"""A control sequence from its beginning to its end, well formed or not. Source: ECMA-48, 5.4."""
_KNOWN_TO_TEXTUAL = re.compile(r"\x1b\[(M|<.*[Mm]|\?[0-9;]*\$y)")
"""Of the mouse, and reports of modes: it looks for them after the keys."""
_EXTENDED = re.compile(r"\x1b\[([0-9:]*)(?:;([0-9:]*)(?:;([0-9:]*))?)?([u~ABCDEFHPQRS])")
_RELEASED = "3"
"""The type of the event in which a key goes up."""
_WITH_OTHERS = 0b11_1110
"""Alt, Ctrl, Super, Hyper and Meta, of the bits of the modifiers."""
_MOST_BITS = 0xFF
_BEGINNINGS = {known[:end] for known in ANSI_SEQUENCES_KEYS for end in range(1, len(known))}


class AltKeyParser(XTermParser):
    """Textual's parser with what is said above."""

    dropped = ""
    """The last that was dropped; empty if nothing was."""

    def feed(self, data: str) -> Iterator[Message]:
        """Parse what was typed; what it fails at is dropped, and a new parser goes on behind it."""
        for character in data:
            try:
                yield from super().feed(character)
            except Exception:  # noqa: BLE001, PERF203 - no key may end the thread that reads them
                self.dropped = character
                self._begin_anew()

    def tick(self) -> Iterator[Message]:
        """Take for keys what has waited for more for long enough."""
        try:
            yield from super().tick()
        except Exception:  # noqa: BLE001 - as above
            self._begin_anew()

    def _begin_anew(self) -> None:
        """Parse from the ground again: a generator that has failed has ended."""
        self._tokens.clear()
        self._gen = self.parse(self._tokens.append)
        self._awaiting = next(self._gen)
        self._timeout_time = None

    def _sequence_to_key_events(self, sequence: str, alt: bool = False) -> Iterable[Key]:
        match = _EXTENDED.fullmatch(sequence)
        plain = sequence if match is None else _plain(match)
        if plain is None:
            self.dropped = sequence
        if not plain:
            return [Key(Keys.Ignore, sequence)]
        keys = list(super()._sequence_to_key_events(plain, alt))
        if keys:
            return keys
        if len(sequence) == 2 and sequence[0] == ESC and sequence[1] not in LONGER:
            return list(super()._sequence_to_key_events(sequence[1], alt=True))
        if _is_unknown(sequence):
            self.dropped = sequence
            return [Key(Keys.Ignore, sequence)]
        return []


def _is_unknown(sequence: str) -> bool:
    """Whether a sequence is whole, and nothing that Textual still looks for."""
    return (
        _WHOLE.fullmatch(sequence) is not None
        and sequence not in _BEGINNINGS
        and _KNOWN_TO_TEXTUAL.fullmatch(sequence) is None
    )


def _plain(match: re.Match[str]) -> str | None:
    """Return a key of the kitty protocol in the form that Textual reads.

    Empty for a key that goes up; None for no key.
    """
    key, modifiers, text, end = match.groups(default="")
    number, _, alternates = key.partition(":")
    bits, _, event = modifiers.partition(":")
    if event == _RELEASED:
        return ""
    try:
        code, held = int(number or "1"), int(bits or "1") - 1
        base, typed = int(alternates.partition(":")[2] or "0"), _codes(text)
    except ValueError:
        return None
    if held & _WITH_OTHERS and code >= 0x80 and _is_character(code):
        # By its place: what types a letter is another matter.
        code = base or ord(LATIN_OF.get(chr(code).lower(), chr(code)))
        number = str(code)
    # Text that no key has typed comes with key 0.
    characters = typed if typed and not code else [code, *typed]
    if not 0 <= held <= _MOST_BITS or not all(map(_is_character, characters)):
        return None
    fields = [number, bits, text]
    while len(fields) > 1 and not fields[-1]:
        fields.pop()
    return f"{ESC}[{';'.join(fields)}{end}"


def _codes(text: str) -> list[int]:
    return [int(part) for part in text.split(":") if part]


def _is_character(code: int) -> bool:
    """Whether it is a code point that may stand alone. Source: Unicode, D76."""
    return 0 < code <= 0x10FFFF and not 0xD800 <= code <= 0xDFFF
