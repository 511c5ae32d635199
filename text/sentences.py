"""Sentences that can still be translated after they were made.

Rooms that know nothing of languages make them; who shows them looks the template up in a catalogue
(`text.i18n.said`). A sentence made by `say` is its English text, a plain `str` for everyone, and
remembers the template and the values that it was made of.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.plain import filled

if TYPE_CHECKING:
    from typing_extensions import Self


class Words(str):
    """An English sentence that remembers what it was made of.

    As a text it is harmless, whatever its values are; `values` holds them as they came.
    """

    __slots__ = ("template", "values")

    template: str
    values: dict[str, object]

    def __new__(cls, template: str, values: dict[str, object]) -> Self:
        """Fill `template`, in the manner of `str.format`, with `values`."""
        words = super().__new__(cls, filled(template, values))
        words.template = template
        words.values = values
        return words

    def __getnewargs__(self) -> tuple[str, dict[str, object]]:  # type: ignore[override]
        """Make copying and pickling keep the template."""
        return self.template, self.values


def say(template: str, **values: object) -> Words:
    """Make a sentence: `say("no such node: {node}", node=name)`."""
    return Words(template, values)
