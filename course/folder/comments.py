"""A starter's words in one language.

Its files have each comment in English, and below it in Russian; what it logs in English, and behind it `# ru: "..."`.
"""

from __future__ import annotations

import re

_COMMENTS = re.compile(r"(?:^[ \t]*#.*\n)+", re.MULTILINE)
_RUSSIAN = re.compile("[а-яё]", re.IGNORECASE)
_QUOTED = re.compile('"[^"]*"')
"""Words that the course's nodes know are Russian in every language."""
_DOCSTRING = re.compile(r'"""([^"а-яё]+\.) ([^"]*[а-яё][^"]*)"""', re.IGNORECASE)
_LOGGED = re.compile(r'"([^"\n]*)"\)  # ru: ("[^"\n]*")')


def in_language(content: bytes, code: str) -> bytes:
    """Return the content of a file without the words in the other language."""
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError:
        return content
    russian = code == "ru"
    text = _DOCSTRING.sub(r'"""\2"""' if russian else r'"""\1"""', text)
    text = _LOGGED.sub(r"\2)" if russian else r'"\1")', text)
    text = _COMMENTS.sub(lambda found: _kept(found[0].splitlines(keepends=True), russian=russian), text)
    return text.encode("utf-8")


def _kept(lines: list[str], *, russian: bool) -> str:
    """Return the lines of a comment in one language; those that have no translation stay."""
    is_russian = [_RUSSIAN.search(_QUOTED.sub("", line)) is not None for line in lines]
    if not russian:
        return "".join(line for line, of_it in zip(lines, is_russian, strict=True) if not of_it)
    kept: list[str] = []
    translated = False
    for line, of_it in zip(reversed(lines), reversed(is_russian), strict=True):
        translated = of_it or translated
        if of_it or not translated:
            kept.append(line)
    return "".join(reversed(kept))
