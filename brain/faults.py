"""Why a model gave no answer, in words, with what to do about it.

Every way in which a server can fail ends in a `ModelError`; whoever asks moves nothing on one.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

from text.sentences import say

if TYPE_CHECKING:
    from text.sentences import Words


class FaultKind(Enum):
    """The ways to fail."""

    SETTINGS = "settings"
    """The settings or the key cannot be used, or there are none."""
    PROMPT = "prompt"
    """The user's own prompt cannot be read."""
    BUDGET = "budget"
    """Deck did not ask: the budget is spent."""
    UNREACHABLE = "unreachable"
    """Nobody answers at the server's address."""
    KEY = "key"
    """The server does not take the key."""
    MODEL = "model"
    """The server does not know the model, or not this kind of request."""
    REQUEST = "request"
    """The server finds fault with the request."""
    BUSY = "busy"
    """Too many requests, or the account is empty."""
    SERVER = "server"
    TIMEOUT = "timeout"
    CUT = "cut"
    """The connection was lost in the middle of the answer, or before it."""
    EMPTY = "empty"
    REFUSAL = "refusal"
    """The model refused to answer, or a filter took the answer away."""
    TOO_LONG = "too long"
    NOT_AN_API = "not an API"
    """Something answered that is no server of models."""
    SHAPE = "shape"
    """The answer is not in the form that was asked for, not even the second one."""


class ModelError(Exception):
    """No usable answer; str() is the reason in English."""

    def __init__(self, kind: FaultKind, words: Words, fix: str = "", *, retry_after_s: float | None = None) -> None:
        """`words` and `fix` are made by `text.sentences.say`."""
        super().__init__(words)
        self.kind, self.words, self.fix = kind, words, fix
        self.retry_after_s = retry_after_s
        """The server wishes to be left alone for this long."""


def cut_off() -> ModelError:
    """Return the fault of an answer that did not come to its end."""
    return ModelError(FaultKind.CUT, say("the connection was lost in the middle of the answer"))


def not_set_up() -> ModelError:
    """Return the fault of having no settings at all."""
    return ModelError(
        FaultKind.SETTINGS, say("no language model is set up"), say("docs/models.md tells how to choose one")
    )
