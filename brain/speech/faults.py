"""Why speech is neither recognised nor spoken, in words, with what to do about it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.sentences import say

if TYPE_CHECKING:
    from text.sentences import Words


class SpeechError(Exception):
    """A recogniser or a voice cannot work; str() is the reason in English."""

    def __init__(self, words: Words, fix: str = "") -> None:
        """`words` and `fix` are made by `text.sentences.say`."""
        super().__init__(words)
        self.words, self.fix = words, fix

    @property
    def sentence(self) -> Words:
        """Return the reason and the fix."""
        if not self.fix:
            return self.words
        return say("{problem}: {fix}", problem=self.words, fix=self.fix)


def missing(package: str, install: str) -> SpeechError:
    """Return the fault of a Python package that is not installed."""
    return SpeechError(
        say("{package} is not installed", package=package), say("pip install {install}", install=install)
    )
