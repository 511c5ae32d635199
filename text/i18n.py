"""The language of the screen: English in the code, Russian from a gettext catalogue.

Strings are looked up when they are drawn, so that the language of a running screen can change; a
string in a constant is marked with `N_` and translated when it is drawn.
"""

from __future__ import annotations

import gettext as _gettext
import os
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from text.plain import filled, plain, plain_lines
from text.sentences import InLanguages, Words

if TYPE_CHECKING:
    from typing_extensions import Self

LOCALE = Path(__file__).parent / "locale"
DOMAIN = "deck"
LANGUAGES = ("en", "ru")
NAMES = {"en": "English", "ru": "Русский"}

_language = "en"
_catalogue: _gettext.NullTranslations = _gettext.NullTranslations()


def detect(option: str | None = None, environ: Mapping[str, str] | None = None, settled: str = "") -> str:
    """Return the language: `--lang`, `DECK_LANG`, the `settled` one, the locale's, else English."""
    env = os.environ if environ is None else environ
    locale = env.get("LC_ALL") or env.get("LC_MESSAGES") or env.get("LANG")
    for wish in (option, env.get("DECK_LANG"), settled, locale):
        code = (wish or "").replace("-", "_").split("_")[0].split(".")[0].lower()
        if code in LANGUAGES:
            return code
    return "en"


def set_language(code: str) -> None:
    """Use the language `code` from now on.

    Raises:
        ValueError: if there is no such language; the message names the available ones.
    """
    global _language, _catalogue  # noqa: PLW0603 - one screen, one language
    if code not in LANGUAGES:
        raise ValueError(f"no language {code!r}: choose {' or '.join(LANGUAGES)}")
    _language = code
    _catalogue = _catalogue_of(code)


@lru_cache
def _catalogue_of(code: str) -> _gettext.NullTranslations:
    if code == "en":
        return _gettext.NullTranslations()
    return _gettext.translation(DOMAIN, LOCALE, [code], fallback=True)


def language() -> str:
    """Return the code of the current language."""
    return _language


def _(message: str) -> str:
    """Return `message` in the current language."""
    return _catalogue.gettext(message) if message else ""


def in_every_language(message: str) -> tuple[str, ...]:
    """Return `message` in each of `LANGUAGES`, for searching text that is marked with `N_`."""
    return tuple(translated(message, code) for code in LANGUAGES)


def ngettext(singular: str, plural: str, number: int) -> str:
    """Return the form of the message for `number`."""
    return _catalogue.ngettext(singular, plural, number)


def N_(message: str) -> str:  # noqa: N802 - gettext's own name
    """Mark `message` for the catalogue; the code that draws it calls `_`."""
    return message


def localized(words: str, code: str = "") -> str:
    """Return a sentence (`text.sentences.say`) in this language, or in the current one.

    Its values, and any other text, are sanitized.
    """
    code = code or _language
    if isinstance(words, InLanguages):
        return plain_lines(words.texts.get(code) or words)
    if not isinstance(words, Words):
        return plain_lines(words)
    values = {name: _in_words(value, code) for name, value in words.values.items()}
    return filled(translated(words.template, code), values)


def translated(message: str, code: str) -> str:
    """Return `message` in this language, whatever the current one is."""
    return _catalogue_of(code).gettext(message) if message else ""


def decimal(number: str, code: str = "") -> str:
    """Return a number in a sentence as a language writes it: `0,36` in Russian.

    Without a `code`, the current language is meant. Data that is echoed, edited or sent keeps its
    decimal point.
    """
    return number.replace(".", ",") if (code or _language) == "ru" else number


class LocalizedFloat(float):
    """A number that a template writes as its language requires, with any format."""

    code: str

    def __new__(cls, number: float, code: str = "") -> Self:
        """Without a `code`, the current language is used."""
        made = super().__new__(cls, number)
        made.code = code or _language
        return made

    def __format__(self, spec: str) -> str:
        return decimal(super().__format__(spec), self.code)


def _in_words(value: object, code: str) -> object:
    if isinstance(value, str):
        return localized(value, code)
    return LocalizedFloat(value, code) if isinstance(value, float) else value


def pick(texts: Mapping[str, str]) -> str:
    """Return the text for the current language from {code: text}, else English, else any."""
    return plain(texts.get(_language) or texts.get("en") or next(iter(texts.values()), ""))
