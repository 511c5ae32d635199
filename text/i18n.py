"""The language of the screen: English in the code, Russian by a gettext catalogue.

Strings are looked up where they are drawn, so that the language can change under a running
screen; a string that must stand in a constant is marked with `N_` and translated when drawn.
"""

from __future__ import annotations

import gettext as _gettext
import os
from collections.abc import Mapping
from pathlib import Path

from text.plain import filled, plain, plain_lines

LOCALE = Path(__file__).parent / "locale"
DOMAIN = "deck"
LANGUAGES = ("en", "ru")
NAMES = {"en": "English", "ru": "Русский"}

_language = "en"
_catalogue: _gettext.NullTranslations = _gettext.NullTranslations()


def detect(
    option: str | None = None, environ: Mapping[str, str] | None = None, settled: str = ""
) -> str:
    """Return the language: `--lang`, `DECK_LANG`, what is settled, the locale, else English."""
    env = os.environ if environ is None else environ
    locale = env.get("LC_ALL") or env.get("LC_MESSAGES") or env.get("LANG")
    for wish in (option, env.get("DECK_LANG"), settled, locale):
        code = (wish or "").replace("-", "_").split("_")[0].split(".")[0].lower()
        if code in LANGUAGES:
            return code
    return "en"


def set_language(code: str) -> None:
    """Speak `code` from now on.

    Raises:
        ValueError: if there is no such language; the message names those there are.
    """
    global _language, _catalogue  # noqa: PLW0603 - one screen, one language
    if code not in LANGUAGES:
        raise ValueError(f"no language {code!r}: choose {' or '.join(LANGUAGES)}")
    _language = code
    _catalogue = _catalogue_of(code)


def _catalogue_of(code: str) -> _gettext.NullTranslations:
    if code == "en":
        return _gettext.NullTranslations()
    return _gettext.translation(DOMAIN, LOCALE, [code], fallback=True)


def language() -> str:
    """Return the code of the language spoken now."""
    return _language


def _(message: str) -> str:
    """Return `message` in the language spoken now."""
    return _catalogue.gettext(message) if message else ""


def in_every_language(message: str) -> tuple[str, ...]:
    """Return `message` as each of `LANGUAGES` has it; what is marked by `N_` is looked for so."""
    return tuple(_catalogue_of(code).gettext(message) for code in LANGUAGES)


def ngettext(singular: str, plural: str, number: int) -> str:
    """Return the form of the message that goes with `number`."""
    return _catalogue.ngettext(singular, plural, number)


def N_(message: str) -> str:  # noqa: N802 - gettext's own name
    """Mark `message` for the catalogue; whoever draws it calls `_`."""
    return message


def said(words: str) -> str:
    """Return a sentence of the launcher (`text.sentences.say`) in the language spoken now.

    Its values, and a text that is no such sentence, are made harmless.
    """
    template = getattr(words, "template", None)
    if template is None:
        return plain_lines(words)
    found: dict[str, object] = getattr(words, "values", {})
    return filled(_(template), {name: _in_words(value) for name, value in found.items()})


def decimal(number: str) -> str:
    """Return a number of prose as it is written in the language spoken: `0,36` in Russian.

    Data keep their point: what is echoed, edited or sent.
    """
    return number.replace(".", ",") if _language == "ru" else number


class Prose(float):
    """A number that a template writes as `decimal` does, whatever format it asks for."""

    def __format__(self, spec: str) -> str:
        return decimal(super().__format__(spec))


def _in_words(value: object) -> object:
    if isinstance(value, str):
        return said(value)
    return Prose(value) if isinstance(value, float) else value


def pick(texts: Mapping[str, str]) -> str:
    """Return the text in the language spoken now out of {code: text}, else English, else any."""
    return plain(texts.get(_language) or texts.get("en") or next(iter(texts.values()), ""))
