"""Whatever a server does, the client says it in words, asks once, and shows no key."""

from __future__ import annotations

import asyncio
import json
import socket
from collections.abc import Callable
from typing import Any

import pytest

from brain.budget import Ledger
from brain.client import LONGEST_TEXT, ModelRequest
from brain.faults import FaultKind, ModelError
from brain.settings import ModelSettings
from tests.model_server import KEY, Exchange, ModelServer
from tests.unit.brain.asking import HELLO, client_of

ASKED = ModelRequest(HELLO, "m-1")
Script = Callable[[Exchange], None]


def piecemeal(exchange: Exchange, *pieces: str) -> None:
    exchange.begins()
    for piece in pieces:
        exchange.piece({"content": piece})


async def fault_with(script: Script, **fields: Any) -> ModelError:
    with ModelServer(script) as server:
        async with client_of(server, **fields) as client:
            with pytest.raises(ModelError) as raised:
                await client.ask(ASKED)
        assert len(server.exchanges) == 1, "asked once, and not again behind the user's back"
    assert KEY not in f"{raised.value!r} {raised.value.fix} {raised.value.__cause__!r}"
    return raised.value


async def test_an_answer_comes_in_pieces_and_is_counted() -> None:
    """The pieces come as they are sent; tokens and times are what the server says."""
    pieces: list[str] = []
    ledger = Ledger()
    with ModelServer(lambda exchange: exchange.says("The way is clear.")) as server:
        async with client_of(server, ledger) as client:
            answer = await client.ask(ASKED, pieces.append)
        sent = server.exchanges[0]
    assert answer.text == "The way is clear."
    assert pieces == ["The way", " is cle", "ar."]
    usage = answer.usage
    assert (usage.model, usage.input_tokens, usage.output_tokens) == ("m-1", 120, 40)
    assert usage.counted
    assert 0 < usage.first_token_s <= usage.total_s
    assert ledger.totals().tokens == 160
    assert sent.headers["authorization"] == f"Bearer {KEY}"
    assert (sent.request["model"], sent.request["messages"]) == ("m-1", HELLO)


@pytest.mark.parametrize(
    ("status", "kind", "words"),
    [
        (401, FaultKind.KEY, "does not take the key (401)"),
        (403, FaultKind.KEY, "does not take the key (403)"),
        (404, FaultKind.MODEL, "does not know the model m-1"),
        (400, FaultKind.REQUEST, "refuses the request (400): Incorrect key *** provided"),
        (500, FaultKind.SERVER, "failed (500): Incorrect key *** provided"),
        (503, FaultKind.SERVER, "failed (503)"),
    ],
)
async def test_each_status_has_its_own_words(status: int, kind: FaultKind, words: str) -> None:
    """The server's own message is shown, without the key that it may repeat."""
    body = json.dumps({"error": {"message": f"Incorrect key {KEY} provided\x1b[2J"}})
    fault = await fault_with(lambda exchange: exchange.fails(status, body))
    assert fault.kind is kind
    assert words in str(fault)
    assert "\x1b" not in str(fault)


async def test_a_server_that_wants_to_be_left_alone_is() -> None:
    """429 with Retry-After: until then nothing is sent at all."""
    with ModelServer(lambda exchange: exchange.fails(429, Retry_After="7")) as server:
        async with client_of(server) as client:
            for _ in range(3):
                with pytest.raises(ModelError) as raised:
                    await client.ask(ASKED)
                assert raised.value.kind is FaultKind.BUSY
                assert raised.value.retry_after_s == pytest.approx(7, abs=2)
        assert len(server.exchanges) == 1


async def test_nobody_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    settings = ModelSettings(base_url=f"http://127.0.0.1:{port}/v1", model="m")
    with ModelServer(lambda _: None) as server:
        client = client_of(server)
        client.settings = settings
        with pytest.raises(ModelError, match=f"nobody answers at http://127.0.0.1:{port}/v1"):
            await client.ask(ASKED)
        await client.close()


async def test_a_stream_that_is_cut_is_no_answer() -> None:
    """Neither a connection that breaks, nor a stream that stops without its end."""

    def breaks(exchange: Exchange) -> None:
        piecemeal(exchange, '{"thought": "I', " drive")
        raise OSError

    def stops(exchange: Exchange) -> None:
        piecemeal(exchange, '{"thought": "I', " drive")
        exchange.event("[DONE]")
        exchange._handler.wfile.write(b"0\r\n\r\n")

    for script in (breaks, stops):
        fault = await fault_with(script)
        assert fault.kind is FaultKind.CUT
        assert "in the middle of the answer" in str(fault)


async def test_silence_before_and_after_the_first_word_ends() -> None:
    """One limit for the first token, one for the whole answer: each names its setting."""

    def silent(exchange: Exchange) -> None:
        exchange.begins()
        servers[0].closing.wait(20)

    def stuck(exchange: Exchange) -> None:
        piecemeal(exchange, "I")
        servers[0].closing.wait(20)

    servers: list[ModelServer] = []
    cases: tuple[tuple[Script, str, dict[str, Any]], ...] = (
        (silent, "first_token_s", {"first_token_s": 0.3, "timeout_s": 60.0}),
        (stuck, "timeout_s", {"first_token_s": 60.0, "timeout_s": 0.8}),
    )
    for script, setting, limits in cases:
        with ModelServer(script) as server:
            servers[:] = [server]
            async with client_of(server, **limits) as client:
                with pytest.raises(ModelError) as raised:
                    await client.ask(ASKED)
        assert raised.value.kind is FaultKind.TIMEOUT
        assert setting in raised.value.fix


async def test_what_is_no_answer() -> None:
    """Empty, refused, filtered, cut to a length: none of it is taken for an answer."""

    def refuses(exchange: Exchange) -> None:
        exchange.begins()
        exchange.piece({"refusal": "I do not drive people over."})
        exchange.ends()

    def filtered(exchange: Exchange) -> None:
        piecemeal(exchange, "{")
        exchange.ends("content_filter")

    def too_short(exchange: Exchange) -> None:
        piecemeal(exchange, '{"thought"')
        exchange.ends("length")

    cases: list[tuple[Script, FaultKind, str]] = [
        (lambda exchange: exchange.says(""), FaultKind.EMPTY, "is empty"),
        (lambda exchange: exchange.says(" \n"), FaultKind.EMPTY, "is empty"),
        (refuses, FaultKind.REFUSAL, "refuses: I do not drive people over."),
        (filtered, FaultKind.REFUSAL, "filter"),
        (too_short, FaultKind.TOO_LONG, "longer than the server allows"),
    ]
    for script, kind, words in cases:
        fault = await fault_with(script)
        assert fault.kind is kind
        assert words in str(fault)


async def test_an_answer_without_end_is_cut_off() -> None:
    """Ten megabytes in pieces, or in one line: neither is read to its end."""

    def pieces(exchange: Exchange) -> None:
        exchange.begins()
        for _ in range(10 * (1 << 20) // 4096):
            exchange.piece({"content": "x" * 4096})
        exchange.ends()

    def one_line(exchange: Exchange) -> None:
        exchange.begins()
        exchange.piece({"content": "x" * (10 << 20)})
        exchange.ends()

    assert LONGEST_TEXT < 10 << 20
    for script in (pieces, one_line):
        fault = await fault_with(script)
        assert fault.kind is FaultKind.TOO_LONG
        assert "has no end" in str(fault)


async def test_cancelling_hangs_up() -> None:
    """What an emergency stop does to a question under way: the server is not left to think."""
    begun, hung_up = asyncio.Event(), asyncio.Event()
    loop = asyncio.get_running_loop()

    def talks(exchange: Exchange) -> None:
        piecemeal(exchange, "I")
        loop.call_soon_threadsafe(begun.set)
        try:
            while not server.closing.wait(0.01):
                exchange.piece({"content": "."})
        except OSError:
            loop.call_soon_threadsafe(hung_up.set)

    with ModelServer(talks) as server:
        async with client_of(server) as client:
            asking = asyncio.create_task(client.ask(ASKED))
            await asyncio.wait_for(begun.wait(), 10)
            asking.cancel()
            with pytest.raises(asyncio.CancelledError):
                await asking
            await asyncio.wait_for(hung_up.wait(), 10)
