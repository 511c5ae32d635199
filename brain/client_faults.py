"""The OpenAI client's errors, in words: what the server meant, and what to do about it."""

from __future__ import annotations

import email.utils
import time
from typing import TYPE_CHECKING

import httpx2
import openai

from brain.faults import FaultKind, ModelError, cut_off
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from brain.key import ServerKey
    from brain.settings import ModelSettings

_LONGEST_WORDS = 200
_LONGEST_WAIT_S = 3600.0
_HANGS_UP = (httpx2.ReadError, httpx2.WriteError, httpx2.CloseError, httpx2.RemoteProtocolError)
"""What the transport raises once it is connected."""


def fault_of(error: Exception, settings: ModelSettings, key: ServerKey, *, begun: bool = False) -> ModelError | None:
    """Return what an error means, None for one that is a mistake of Deck's own.

    `begun`: whether some of the answer has come.
    """
    if begun and isinstance(error, httpx2.TransportError | openai.APIConnectionError):
        inner = error.__cause__
        return inner if isinstance(inner, ModelError) else cut_off()
    if isinstance(error, openai.APITimeoutError | httpx2.TimeoutException):
        words = say("no answer within {limit:g} s", limit=settings.timeout_s)
        return ModelError(FaultKind.TIMEOUT, words, say("timeout_s in llm.yaml"))
    if isinstance(error, openai.APIError):
        return _of_api(error, settings, key)
    if isinstance(error, httpx2.HTTPError):
        return cut_off()
    if isinstance(error, UnicodeDecodeError | ValueError | RecursionError):
        # What came is not what the protocol says: broken JSON in the stream, or no UTF-8, or
        # brackets without end.
        words = say("what the server sent cannot be read")
        return ModelError(FaultKind.NOT_AN_API, words)
    return None


def _of_api(error: openai.APIError, settings: ModelSettings, key: ServerKey) -> ModelError:
    if isinstance(error, openai.APIStatusError):
        return _of_status(error, settings, key)
    if isinstance(error, openai.APIConnectionError):
        # The fault of the transport's own limit comes wrapped.
        inner = error.__cause__
        return inner if isinstance(inner, ModelError) else _no_answer(settings, inner)
    words = say("the server broke off: {words}", words=words_of(error.message, key))
    return ModelError(FaultKind.SERVER, words)


def _no_answer(settings: ModelSettings, inner: BaseException | None) -> ModelError:
    """Tell a server that hangs up from one that is not there: the latter is done without."""
    if isinstance(inner, _HANGS_UP):
        return ModelError(FaultKind.CUT, say("the server closed the connection without an answer"))
    return _unreachable(settings, inner)


def _unreachable(settings: ModelSettings, inner: BaseException | None) -> ModelError:
    words = say("nobody answers at {url}", url=settings.base_url)
    fix = say("start the server, or correct base_url in llm.yaml")
    if inner is not None and "certificate" in str(inner).casefold():
        words = say("the certificate of {url} is not trusted", url=settings.base_url)
        fix = say("correct base_url in llm.yaml")
    return ModelError(FaultKind.UNREACHABLE, words, fix)


def _of_status(error: openai.APIStatusError, settings: ModelSettings, key: ServerKey) -> ModelError:
    retry_after = error.response.headers.get("retry-after", "")
    return of_status(error.status_code, words_of(_message(error), key), retry_after, settings)


def _message(error: openai.APIStatusError) -> str:
    """Return the server's own message; the client's is the whole body with a status before it."""
    body = error.body
    inner = body.get("message") if isinstance(body, dict) else None
    return inner if isinstance(inner, str) else error.message


def of_status(status: int, said: str, retry_after: str, settings: ModelSettings) -> ModelError:
    """Return what an HTTP status means; `said` are the server's own words, without the key."""
    if status in (401, 403):
        words = say("the server does not take the key ({status})", status=status)
        return ModelError(FaultKind.KEY, words, say("key_env or key_file in llm.yaml"))
    if status == 404:
        words = say(
            "the server at {url} does not know the model {model}, or this kind of request (404)",
            url=settings.base_url,
            model=settings.model,
        )
        return ModelError(FaultKind.MODEL, words, say("base_url and model in llm.yaml"))
    if status == 429:
        wait_s = retry_after_s(retry_after)
        words = say("the server has too many requests, or the account is empty (429)")
        return ModelError(FaultKind.BUSY, words, retry_after_s=wait_s)
    if status >= 500:
        words = say("the server failed ({status}): {words}", status=status, words=said)
        return ModelError(FaultKind.SERVER, words)
    if 300 <= status < 400:
        words = say("the server at {url} sends elsewhere ({status})", url=settings.base_url, status=status)
        return ModelError(FaultKind.NOT_AN_API, words, say("correct base_url in llm.yaml"))
    words = say("the server refuses the request ({status}): {words}", status=status, words=said)
    return ModelError(FaultKind.REQUEST, words)


def retry_after_s(header: str) -> float | None:
    """Return the seconds of a Retry-After, which may be a date (RFC 9110, 10.2.3)."""
    try:
        wait_s = float(header)
    except ValueError:
        try:
            wait_s = email.utils.parsedate_to_datetime(header).timestamp() - time.time()
        except ValueError:
            return None
    return min(max(wait_s, 0.0), _LONGEST_WAIT_S) if wait_s == wait_s else None  # noqa: PLR0124


def words_of(message: str, key: ServerKey) -> str:
    """Return what a server said: short, printable, and without the key."""
    return plain(key.hidden_in(message)[:_LONGEST_WORDS])
