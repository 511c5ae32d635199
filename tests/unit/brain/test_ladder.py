"""The way to ask for a form is found out by trying, once for a server and model."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from brain.faults import FaultKind, ModelError
from brain.ladder import FILE, Ladder, Rung
from robot.commands.schema import LlmResponse
from tests.model_server import ModelServer, obeys, rung_of
from tests.unit.brain.asking import HELLO, client_of

if TYPE_CHECKING:
    from pathlib import Path

    from tests.model_server import Exchange

SCHEMA = LlmResponse.model_json_schema()
ANSWER = '{"thought": "clear", "commands": []}'


def refusing(*rungs: Rung) -> object:
    """Return a script that refuses these ways with 400, and obeys all others."""

    def script(exchange: Exchange) -> None:
        rung = rung_of(exchange.request)
        if rung in rungs:
            exchange.fails(400, json.dumps({"error": {"message": "unknown response_format"}}))
        elif rung is not None:
            obeys(ANSWER, rung)(exchange)

    return script


@pytest.mark.parametrize("rung", list(Rung))
async def test_the_first_way_that_is_obeyed_is_kept(rung: Rung, tmp_path: Path) -> None:
    """A server that says 200 to every way and ignores the schema is found out."""
    with ModelServer(obeys(ANSWER, rung)) as server:
        async with client_of(server) as client:
            ladder = Ladder(client, "m-1", tmp_path)
            assert (await ladder.ask(SCHEMA, HELLO)).text == ANSWER
        tried = [rung_of(exchange.request) for exchange in server.exchanges]
        assert tried == [*list(Rung)[: list(Rung).index(rung) + 1], rung]
        for exchange in server.exchanges:
            assert not ("response_format" in exchange.request and "tools" in exchange.request)


async def test_a_way_that_is_refused_is_left_for_the_next(tmp_path: Path) -> None:
    """`strict` is not taken everywhere, nor are schemas."""
    with ModelServer(refusing(Rung.STRICT, Rung.SCHEMA)) as server:  # type: ignore[arg-type]
        async with client_of(server) as client:
            assert await Ladder(client, "m-1", tmp_path).rung() is Rung.OBJECT


async def test_the_next_process_knows_it(tmp_path: Path) -> None:
    """It is asked for once, for each server and model; a broken cache is no cache."""
    with ModelServer(obeys(ANSWER, Rung.OBJECT)) as server:
        for model, requests in (("m-1", 3), ("m-1", 3), ("m-2", 6)):
            async with client_of(server) as client:
                await Ladder(client, model, tmp_path).rung()
            assert len(server.exchanges) == requests
        (tmp_path / FILE).write_text("[1, ")
        async with client_of(server) as client:
            assert await Ladder(client, "m-1", tmp_path).rung() is Rung.OBJECT


async def test_a_server_that_changed_is_asked_again(tmp_path: Path) -> None:
    """After a 400 to the known way the question fails, and the next one finds out anew."""
    with ModelServer(obeys(ANSWER, Rung.STRICT)) as server:
        async with client_of(server) as client:
            ladder = Ladder(client, "m-1", tmp_path)
            await ladder.rung()
            server.script = refusing(Rung.STRICT)  # type: ignore[assignment]
            with pytest.raises(ModelError) as raised:
                await ladder.ask(SCHEMA, HELLO)
            assert raised.value.kind is FaultKind.REQUEST
            assert (await ladder.ask(SCHEMA, HELLO)).text == ANSWER


async def test_a_server_that_obeys_nothing_is_told(tmp_path: Path) -> None:
    with ModelServer(lambda exchange: exchange.says("Hello! How can I help?")) as server:
        async with client_of(server) as client:
            with pytest.raises(ModelError, match="gives no answers in the form") as raised:
                await Ladder(client, "m-1", tmp_path).ask(SCHEMA, HELLO)
    assert raised.value.kind is FaultKind.SHAPE


async def test_a_server_that_always_fails_is_told_as_that(tmp_path: Path) -> None:
    """Not as a model that cannot answer in a form."""
    with ModelServer(lambda exchange: exchange.fails(500)) as server:
        async with client_of(server) as client:
            with pytest.raises(ModelError) as raised:
                await Ladder(client, "m-1", tmp_path).rung()
    assert raised.value.kind is FaultKind.SERVER


async def test_a_wrong_key_ends_the_search(tmp_path: Path) -> None:
    """The three other ways would be refused as well, and the account locked at last."""
    with ModelServer(lambda exchange: exchange.fails(401)) as server:
        async with client_of(server) as client:
            with pytest.raises(ModelError) as raised:
                await Ladder(client, "m-1", tmp_path).rung()
        assert raised.value.kind is FaultKind.KEY
        assert len(server.exchanges) == 1
