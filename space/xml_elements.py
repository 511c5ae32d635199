"""XML as elements that know their lines; a document type, and so any entity, is refused.

The trees of the standard library forget the lines. Memory is bounded by the length of the text and
by `DEEPEST`: without entities nothing is longer than it is written.
"""

from __future__ import annotations

import codecs
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING
from xml.parsers import expat

from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

LONGEST = 4 * 1024 * 1024
"""Bytes. A robot of a hundred joints takes some 200 kB."""
DEEPEST = 100
"""Elements within each other."""

_WORDS = {
    expat.errors.XML_ERROR_NO_ELEMENTS: N_("the text ends before its first element is closed"),
    expat.errors.XML_ERROR_TAG_MISMATCH: N_(
        "this tag closes another element than the one opened last: a closing tag is missing above"
    ),
    expat.errors.XML_ERROR_INVALID_TOKEN: N_(
        "a '<', a quote or a character is where none can be; write &lt; for a '<' outside of tags"
    ),
    expat.errors.XML_ERROR_SYNTAX: N_("this is not XML, which begins with '<'"),
    expat.errors.XML_ERROR_DUPLICATE_ATTRIBUTE: N_("an attribute is given twice: remove one"),
    expat.errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT: N_(
        "something follows the end of the outermost element: remove it, or a tag closes too soon"
    ),
    expat.errors.XML_ERROR_UNDEFINED_ENTITY: N_(
        "only &lt; &gt; &amp; &quot; and &apos; are known: write the character itself"
    ),
}


class XmlError(ValueError):
    """A text is not what it should be; its text is a sentence with the line."""

    def __init__(self, line: int, reason: str, mend: str = "") -> None:
        """Say what is wrong in a line, counted from 1, and what to do."""
        told = say("{reason}; {mend}", reason=reason, mend=mend) if mend else reason
        super().__init__(say("line {line}: {reason}", line=line, reason=told))


@dataclass(slots=True)
class Element:
    """An element as it is written, without its text."""

    tag: str
    line: int
    attributes: dict[str, str]
    children: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> Iterator[Element]:
        return (child for child in self.children if child.tag == tag)

    def first(self, tag: str) -> Element | None:
        """Return the first child with this tag, None without one."""
        return next(self.all(tag), None)

    def wrong(self, reason: str, mend: str = "") -> XmlError:
        return XmlError(self.line, reason, mend)


def too_long() -> XmlError:
    """Return the error for a text that is longer than `LONGEST`."""
    return XmlError(1, say("the text is longer than {limit} MiB", limit=LONGEST // 1024**2))


def read_elements(text: str) -> Element:
    """Return the outermost element of a text. Raises XmlError."""
    try:
        size = len(text.encode())
    except UnicodeEncodeError as error:
        line = text.count("\n", 0, error.start) + 1
        code = f"{ord(text[error.start]):04X}"
        raise XmlError(line, say("the character U+{code} is not allowed: remove it", code=code)) from None
    if size > LONGEST:
        raise too_long()
    reading = _Reading()
    try:
        return reading.root(text)
    except expat.ExpatError as error:
        words = expat.ErrorString(error.code)
        reason = say(_WORDS[words]) if words in _WORDS else say("not XML: {reason}", reason=words)
        raise XmlError(error.lineno, reason) from None


class _Reading:
    def __init__(self) -> None:
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._open
        self._parser.EndElementHandler = self._close
        self._parser.StartDoctypeDeclHandler = self._refuse
        self._opened = [Element("", 0, {})]

    def root(self, text: str) -> Element:
        """Return the outermost element; expat refuses a text that has none, or two."""
        self._parser.Parse(text, True)
        return self._opened[0].children[0]

    def _open(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, self._parser.CurrentLineNumber, attributes)
        if len(self._opened) > DEEPEST:
            raise element.wrong(say("more than {most} elements within each other", most=DEEPEST))
        self._opened[-1].children.append(element)
        self._opened.append(element)

    def _close(self, _tag: str) -> None:
        self._opened.pop()

    def _refuse(self, *_declared: object) -> None:
        raise XmlError(
            self._parser.CurrentLineNumber,
            say("a document type (<!DOCTYPE>) is not read"),
            say("remove it, and write out what it declares"),
        )


_DECLARED = re.compile(r"""\A(\s*<\?xml\s[^>]*?\bencoding\s*=\s*["'])([A-Za-z][\w.-]*)""", re.ASCII)


def decoded(raw: bytes) -> str:
    """Return the text of a file in UTF-8, in UTF-16 with its mark, or in the encoding that it declares.

    Raises XmlError.
    """
    if len(raw) > LONGEST:
        raise too_long()
    found = _DECLARED.match(raw[:1024].decode("latin-1"))
    declared = found[2] if found else "UTF-8"
    encoding = declared
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        encoding = "utf-16"
    elif raw.startswith(codecs.BOM_UTF8) or declared.lower().startswith("utf"):
        # An editor may have declared another one, and written UTF-8.
        encoding = "utf-8-sig"
    try:
        text = raw.decode(encoding)
    except UnicodeDecodeError as error:
        line = raw[: error.start].decode(error.encoding, "replace").count("\n") + 1
        raise XmlError(
            line,
            say("the byte {byte} is not {encoding}", byte=f"0x{raw[error.start]:02X}", encoding=declared),
            say("save the file as UTF-8, or declare the encoding that it is saved in"),
        ) from None
    except LookupError:
        raise XmlError(
            1,
            say("the declared encoding {encoding} is not known", encoding=declared),
            say("save the file as UTF-8, and declare that"),
        ) from None
    return _DECLARED.sub(r"\g<1>UTF-8", text)
