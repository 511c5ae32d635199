"""Sentences that can still be translated after they have been made.

Rooms that know nothing about languages make them; the code that shows them looks up the template in
a catalogue (`text.i18n.localized`). A sentence made by `say` is its English text, a plain `str`,
and remembers the template and values that it was made from.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.plain import filled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from typing_extensions import Self


class Words(str):
    """An English sentence that remembers what it was made from.

    Its text is sanitized, whatever its values are; `values` holds the original ones.
    """

    __slots__ = ("template", "values")

    template: str
    values: dict[str, object]

    def __new__(cls, template: str, values: dict[str, object]) -> Self:
        """Fill `template` with `values`, like `str.format`."""
        words = super().__new__(cls, filled(template, values))
        words.template = template
        words.values = values
        return words

    def __reduce__(self) -> tuple[type[Words], tuple[str, Mapping[str, object]]]:
        """Make copying and pickling keep the template; values may be what has no pickle, such as an error."""
        simple = (str, int, float)
        values = {name: value if isinstance(value, simple) else str(value) for name, value in self.values.items()}
        return type(self), (self.template, values)


class InLanguages(str):
    """A text that its author has written in several languages, as a lesson's hints are.

    It is a plain `str`, the English text; `texts` holds all of them by language.
    """

    __slots__ = ("texts",)

    texts: dict[str, str]

    def __new__(cls, texts: Mapping[str, str]) -> Self:
        """Keep the texts, {language: text}."""
        made = super().__new__(cls, texts.get("en") or next(iter(texts.values()), ""))
        made.texts = dict(texts)
        return made

    def __getnewargs__(self) -> tuple[dict[str, str]]:  # type: ignore[override]
        """Make copying and pickling keep the texts."""
        return (self.texts,)


def say(template: str, **values: object) -> Words:
    """Make a sentence: `say("no such node: {node}", node=name)`."""
    return Words(template, values)


class SaidError(Exception):
    """What went wrong, as a sentence."""

    def __init__(self, words: str) -> None:
        super().__init__(words)
        self.words = words


def reason_of(error: BaseException) -> str:
    """Return what an error says: the sentence it was made with, else its text, else its kind.

    `str` of an error is that sentence in English, which cannot be translated any more.
    """
    if len(error.args) == 1 and isinstance(error.args[0], (Words, InLanguages)):
        return error.args[0]
    return str(error) or type(error).__name__
