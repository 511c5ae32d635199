"""Why a tool did not do what an agent asked for."""

from __future__ import annotations

from text.sentences import Words, say


class RefusedError(Exception):
    """A call that does nothing; `words` says why, to the agent and in the log."""

    def __init__(self, words: Words) -> None:
        """Store the reason, made by `text.sentences.say`."""
        super().__init__(str(words))
        self.words = words


def refused(template: str, **values: object) -> RefusedError:
    """Return a refusal for this reason."""
    return RefusedError(say(template, **values))
