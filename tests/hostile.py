"""Text that somebody could send who means harm, and a look for what of it came out as it was."""

from __future__ import annotations

import re
import unicodedata

CLIPBOARD = "\x1b]52;c;ZXZpbA==\x07"
CONTROLS = f"{CLIPBOARD}\x1bc\x1b[2J\x1b[45mX\x9b45m\x90q\x9d0;title\x9c\x7f\x08\r\n\t"
HIDDEN = "\u202eabc\u202c\u2066\u2069\u200e\u200b\u2060\ufeffa\u200db\u200cc\ufe0f\u3164\u00ad"
TAGS = "\U000e0065\U000e0076\U000e0069\U000e006c\U000e007f"
MARKUP = "[red]x[/red][/][@click=app.quit]y[/]"

EVIL = f"evil{CONTROLS}{HIDDEN}\u2028\u2029{TAGS}{MARKUP}"
"""What fits wherever text without a NUL does: environment, arguments, parameters."""
WORST = f"{EVIL}\0"
"""For where a NUL does, too: YAML and JSON."""
EVIL_NAME = f"evil{CONTROLS}{HIDDEN}{TAGS}[red]"
"""For the name of a file."""

_COLOUR = re.compile(r"\x1b\[(?:0|1|2|3[0-7]|9[0-7])m")
"""All that Deck itself sends from the command line, to a terminal."""


def quoted(text: str) -> str:
    """Return the text as YAML writes it in double quotes, every odd character escaped."""
    return '"' + "".join(map(_escaped, text)) + '"'


def _escaped(one: str) -> str:
    if one.isascii() and one.isprintable() and one not in '"\\':
        return one
    return f"\\U{ord(one):08x}"


def harm_in(output: bytes, *, coloured: bool = False, lines: bool = True) -> list[str]:
    """Return the characters of `output` that steer a terminal, or that nobody sees.

    `coloured`: colours of Deck's own are no harm, nor are the carriage returns of a terminal.
    """
    text = output.decode("utf-8", "surrogateescape")
    if coloured:
        text = _COLOUR.sub("", text).replace("\r\n", "\n")
    return [f"U+{ord(one):04X}" for one in sorted(set(text)) if _harms(one, lines=lines)]


def _harms(one: str, *, lines: bool) -> bool:
    if one == "\n":
        return not lines
    return (
        unicodedata.category(one) in {"Cc", "Cf", "Cs", "Co", "Zl", "Zp"} or one in "\ufe0f\u3164"
    )
