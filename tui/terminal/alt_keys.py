"""Alt with a letter, whatever comes next.

A terminal sends it as ESC and the letter. Textual waits 0.1 s for more of a sequence, and if a
sequence of another key or of the mouse begins meanwhile, it takes the first for `^` and the bare
letter: a held Alt+V would open the viewer, which is on `v`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual._xterm_parser import XTermParser

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.events import Key

ESC = "\x1b"
LONGER = frozenset("[OPX]^_") | {ESC}
"""What follows ESC in sequences of more than two characters. Source: ECMA-48, 5.3 and 8.3."""


class AltKeyParser(XTermParser):
    """Textual's parser, but for Alt with one character, which is a key as soon as it has come."""

    def _sequence_to_key_events(self, sequence: str, alt: bool = False) -> Iterable[Key]:
        keys = list(super()._sequence_to_key_events(sequence, alt))
        if not keys and len(sequence) == 2 and sequence[0] == ESC and sequence[1] not in LONGER:
            keys = list(super()._sequence_to_key_events(sequence[1], alt=True))
        return keys
