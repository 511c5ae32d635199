"""From the bytes of an XML file to its text: by their mark, or by the encoding that it declares.

The text is handed on to others, who take it for UTF-8 whatever it declares, as RViz does: what it
declares is fixed with it.
"""

from __future__ import annotations

import codecs
import re

from space.xml_elements import LONGEST, XmlError, too_long
from text.sentences import say

UTF8 = "utf-8"
_BEGINNINGS = (
    # The longer first: UTF-32 begins as UTF-16 does.
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF8, UTF8),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
    (b"<\0", "utf-16-le"),
    (b"\0<", "utf-16-be"),
)
_MARK = "\ufeff"
_DECLARED = re.compile(r"""(\s*<\?xml\s[^>]*?\bencoding\s*=\s*["'])([A-Za-z][\w.-]*)""", re.ASCII)
_DECLARATION = '<?xml version="1.0" encoding="windows-1251"?>'


def decoded(raw: bytes) -> str:
    """Return the text of a file. Raises XmlError."""
    if len(raw) > LONGEST:
        raise too_long()
    encoding = next((name for begin, name in _BEGINNINGS if raw.startswith(begin)), "")
    found = _DECLARED.match(raw[:1024].decode("latin-1"))
    declared = found[2] if found and not encoding else ""
    try:
        text = raw.decode(encoding or _codec(declared))
    except UnicodeDecodeError as error:
        raise _not_decoded(raw, error, declared or encoding) from None
    text = text.removeprefix(_MARK)
    found = _DECLARED.match(text)
    if found is None or found[2].lower() == UTF8:
        return text
    return f"{found[1]}{UTF8.upper()}{text[found.end() :]}"


def _codec(declared: str) -> str:
    """Return what decodes a text that declares this encoding in bytes of ASCII."""
    try:
        name = codecs.lookup(declared or UTF8).name
        if name.startswith(("utf-16", "utf-32")):
            # An editor declared it and wrote UTF-8; the declaration could not be read otherwise.
            return UTF8
        b"<".decode(name)  # not every codec is one of texts
    except (LookupError, UnicodeError):
        raise XmlError(
            1,
            say("the declared encoding {encoding} is not known", encoding=declared),
            say("save the file as UTF-8, and declare that"),
        ) from None
    return name


def _not_decoded(raw: bytes, error: UnicodeDecodeError, said: str) -> XmlError:
    line = raw[: error.start].decode(error.encoding, "replace").count("\n") + 1
    byte = f"0x{raw[error.start]:02X}"
    if said:
        return XmlError(
            line,
            say("the byte {byte} is not {encoding}, as the file says", byte=byte, encoding=said),
            say("declare the encoding that the file is saved in, or save it as {encoding}", encoding=said),
        )
    return XmlError(
        line,
        say("the byte {byte} is not UTF-8, and no other encoding is declared", byte=byte),
        say(
            "save the file as UTF-8, or declare its encoding in the first line, such as {declaration}",
            declaration=_DECLARATION,
        ),
    )
