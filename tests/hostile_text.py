"""Text that somebody could send who means harm, and a look for what of it came out as it was."""

from __future__ import annotations

import base64
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import fields as dataclass_fields
from dataclasses import is_dataclass, replace
from enum import Enum
from typing import Any

from tui.terminal.pixels import KITTY_QUESTION

CLIPBOARD = "\x1b]52;c;ZXZpbA==\x07"
CONTROLS = f"{CLIPBOARD}\x1bc\x1b[2J\x1b[45mX\x9b45m\x90q\x9d0;title\x9c\x7f\x08\r\n\t"
HIDDEN = "\u202eabc\u202c\u2066\u2069\u200e\u200b\u2060\ufeffa\u200db\u200cc\ufe0f\u3164\u00ad"
TAGS = "\U000e0065\U000e0076\U000e0069\U000e006c\U000e007f"
MARKUP = "[red]x[/red][/][link=file:///etc]z[/link][@click=app.quit]y[/]"

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
    first = {one: text.index(one) for one in sorted(set(text)) if _harms(one, lines=lines)}
    return [f"U+{ord(one):04X} in {text[max(0, at - 40) : at + 10]!r}" for one, at in first.items()]


def _harms(one: str, *, lines: bool) -> bool:
    if one == "\n":
        return not lines
    return unicodedata.category(one) in {"Cc", "Cf", "Cs", "Co", "Zl", "Zp"} or one in "\ufe0f\u3164"


_SEQUENCE = re.compile(rf"\x1b\[[0-?]*[ -/]*[@-~]|\x1b[>=78]|\x1b\]22;\w*\x07|{re.escape(KITTY_QUESTION)}")
"""What Textual sends: colours, places, modes, the shape of the pointer; and whether there are pictures."""
_COPY = re.compile(r"\x1b\]52;c;([A-Za-z0-9+/=]*)\x07")
_OURS = ("\x1b[45m", "\x1b[2J", CLIPBOARD, "\x1bc", "\x1b]8;")
"""Those of the hostile texts, and a link, that Textual never sends."""


def harm_on_screen(written: str) -> list[str]:
    """Return what a screen wrote to the terminal that steers it, or that nobody sees.

    What Deck's own copying puts into the clipboard is looked through as lines of text.
    """
    found = [repr(each) for each in _OURS if each in written]
    copies = _COPY.findall(written)
    rest = _SEQUENCE.sub("", _COPY.sub("", written))
    rest = rest.replace("\r\n", "\n").replace("\a", "")
    return [
        *found,
        *harm_in(rest.encode("utf-8", "surrogatepass")),
        *(harm for copy in copies for harm in harm_in(base64.b64decode(copy))),
    ]


def poisoned(value: Any, poison: str = EVIL) -> Any:
    """Return plain data of which every text says something evil as well."""
    if isinstance(value, str) and not isinstance(value, Enum):
        return value + poison
    if isinstance(value, (bytes, bytearray)):
        return bytes(value) + poison.encode()
    if isinstance(value, Mapping):
        return {poisoned(key, poison): poisoned(one, poison) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        ones = (poisoned(one, poison) for one in value)
        return type(value)(*ones) if hasattr(value, "_fields") else type(value)(ones)
    if is_dataclass(value) and not isinstance(value, type):
        return _poisoned_fields(value, poison)
    return value


def _poisoned_fields(value: Any, poison: str) -> Any:
    fields = {each.name: getattr(value, each.name) for each in dataclass_fields(value)}
    return replace(value, **{name: poisoned(one, poison) for name, one in fields.items()})
