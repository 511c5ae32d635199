"""The OpenAI client, held to the settings, with a transport that ends an answer which is too long.

The OpenAI client reads whatever comes: ten megabytes of one line would all be kept, and a packed
answer of one megabyte unpacks to a thousand. So none is asked for, and if one comes all the same,
it is unpacked here, where what comes out of it is counted.
"""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING

import httpx2
import openai

from brain.faults import FaultKind, ModelError
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from brain.key import ServerKey
    from brain.settings import ModelSettings

LONGEST_ANSWER = 4 << 20
"""Bytes of one answer, on the wire and unpacked: a token takes some 200 of them in a stream."""
_GZIP = zlib.MAX_WBITS | 16
_PACKED_BY = "content-encoding"


def bounded_client(settings: ModelSettings, key: ServerKey) -> openai.AsyncOpenAI:
    """Return a client that asks once, reads no endless answer, and goes where the settings say."""
    return openai.AsyncOpenAI(
        base_url=settings.base_url,
        # The client insists on one; a server on this machine takes any.
        api_key=key.reveal() or "none",
        max_retries=0,
        timeout=settings.timeout_s,
        # No redirects: the key, and what was seen or said, go where the settings say.
        http_client=httpx2.AsyncClient(transport=BoundedTransport(), follow_redirects=False),
    )


class BoundedTransport(httpx2.AsyncBaseTransport):
    """Passes requests on, and counts the bytes of what comes back."""

    def __init__(self, longest: int = LONGEST_ANSWER) -> None:
        # A connection for each request: a server may close one that is kept just when the next
        # request goes out by it, and a question is not to be repeated. llama.cpp does.
        self._inner = httpx2.AsyncHTTPTransport(limits=httpx2.Limits(max_keepalive_connections=0))
        self._longest = longest

    async def handle_async_request(self, request: httpx2.Request) -> httpx2.Response:
        """Send a request; its answer's body raises ModelError beyond the limit."""
        request.headers["accept-encoding"] = "identity"
        response = await self._inner.handle_async_request(request)
        stream = response.stream
        assert isinstance(stream, httpx2.AsyncByteStream)
        packed_by = response.headers.pop(_PACKED_BY, "identity").strip().lower()
        if packed_by not in ("identity", "gzip"):
            await response.aclose()
            words = say("the server packs its answers by {packed_by}", packed_by=packed_by[:20])
            raise ModelError(FaultKind.NOT_AN_API, words, say("have it send them as they are"))
        return httpx2.Response(
            response.status_code,
            headers=response.headers,
            stream=_BoundedStream(stream, self._longest, unpack=packed_by == "gzip"),
            extensions=response.extensions,
        )

    async def aclose(self) -> None:
        await self._inner.aclose()


class _BoundedStream(httpx2.AsyncByteStream):
    def __init__(self, inner: httpx2.AsyncByteStream, longest: int, *, unpack: bool) -> None:
        self._inner, self._left, self._longest = inner, longest, longest
        self._gzip = zlib.decompressobj(_GZIP) if unpack else None
        self._unpacked = 0

    async def __aiter__(self) -> AsyncIterator[bytes]:
        async for block in self._inner:
            self._left -= len(block)
            plain = self._plain(block)
            if self._left < 0 or self._unpacked > self._longest:
                raise ModelError(FaultKind.TOO_LONG, say("the answer has no end: cut off"))
            yield plain

    def _plain(self, block: bytes) -> bytes:
        """Return what a block unpacks to, of which no more is made than may still come."""
        if self._gzip is None:
            return block
        try:
            plain = self._gzip.decompress(block, self._longest - self._unpacked + 1)
        except zlib.error:
            words = say("what the server sent cannot be read")
            raise ModelError(FaultKind.NOT_AN_API, words) from None
        self._unpacked += len(plain)
        return plain

    async def aclose(self) -> None:
        await self._inner.aclose()
