"""Why a model file is not served."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from text.sentences import Words


class ServingError(Exception):
    """It cannot be served; str() is the reason in English."""

    def __init__(self, words: Words) -> None:
        """`words` are made by `text.sentences.say`, and name the fix."""
        super().__init__(words)
        self.words = words
