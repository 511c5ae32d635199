"""The Realtime protocol, against a server that speaks what is published: none of OpenAI's own."""

from __future__ import annotations

import asyncio
import base64
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest

from brain.budget import Ledger
from brain.faults import FaultKind, ModelError
from brain.key import ServerKey
from brain.realtime import ACT, SENSE, RealtimeTalk, TalkHandlers
from brain.settings import ModelSettings
from tests.model_server import KEY
from tests.realtime_server import RealtimeServer, Talk
from tests.waiting import until

DRIVE = {"action": "drive", "speed": 0.2, "steering": 0.0}
GO = json.dumps({"thought": "go", "commands": [DRIVE]})


class Client:
    """A client that notes everything it is told."""

    def __init__(self, server: RealtimeServer, **fields: Any) -> None:
        self.told: list[tuple[str, Any]] = []
        self.ledger = Ledger()
        settings = ModelSettings(base_url=server.url, model="m", realtime_model="rt-1", **fields)
        self.talk = RealtimeTalk(settings, ServerKey(KEY), self.ledger, "test", "Be careful.", self._handlers())

    def of(self, kind: str) -> list[Any]:
        return [value for name, value in self.told if name == kind]

    async def fault(self) -> ModelError:
        """Talk to the end; return what it ended with."""
        with pytest.raises(ModelError) as raised:
            await asyncio.wait_for(self.talk.run(), 20)
        assert KEY not in f"{raised.value!r} {raised.value.__cause__!r}"
        return raised.value

    def _handlers(self) -> TalkHandlers:
        def note(kind: str) -> Any:
            return lambda value: self.told.append((kind, value))

        names = ("sound", "heard", "said", "act", "refused", "used")
        return TalkHandlers(
            **{name: note(name) for name in names},
            interrupted=lambda: self.told.append(("interrupted", None)),
            sense=lambda: "Distance ahead: 2.00 m",
        )


@asynccontextmanager
async def talking(client: Client) -> AsyncIterator[None]:
    running = asyncio.create_task(client.talk.run())
    try:
        yield
    finally:
        running.cancel()
        with pytest.raises(asyncio.CancelledError):
            await running


async def quiet(_: Talk) -> None:
    """Say nothing."""


async def test_the_session_is_set_up_and_sound_goes_up() -> None:
    """Address, key and model; prompt, format, turn detection and functions; then the microphone."""
    with RealtimeServer(quiet) as server:
        client = Client(server)
        async with talking(client):
            client.talk.hear(b"\x01\x00" * 240)
            await until(lambda: server.talks, "a connection")
            talk = server.talks[0]
            (sound,) = await asyncio.to_thread(server.run, talk.got("input_audio_buffer.append"))
    assert base64.b64decode(sound["audio"]) == b"\x01\x00" * 240
    assert talk.path == "/v1/realtime?model=rt-1"
    assert talk.headers["authorization"] == f"Bearer {KEY}"
    session = talk.those("session.update")[0]["session"]
    assert session["instructions"] == "Be careful."
    assert session["audio"]["input"]["turn_detection"]["type"] == "server_vad"
    assert session["audio"]["input"]["format"] == {"type": "audio/pcm", "rate": 24_000}
    assert {tool["name"] for tool in session["tools"]} == {ACT, SENSE}


async def test_a_voice_becomes_commands_and_the_answer_is_heard() -> None:
    """Heard, looked, done once though called twice, said; the tokens are counted."""

    async def script(talk: Talk) -> None:
        await talk.hears("go on")
        await talk.calls(SENSE, "{}", "call-1")
        await talk.calls(ACT, GO, "call-2")
        await talk.calls(ACT, GO, "call-2")
        await talk.says(b"\x01\x00", b"\x02\x00", words="I go.")
        await talk.got("conversation.item.create", 2)

    with RealtimeServer(script) as server:
        client = Client(server)
        async with talking(client):
            await until(lambda: client.of("said"), "the words of the answer")
            await until(lambda: len(client.of("used")) == 4, "four answers")
            await until(lambda: len(server.talks[0].those("conversation.item.create")) == 2, "two outcomes")
    assert client.of("heard") == ["go on"]
    assert [response.commands[0].model_dump() for response in client.of("act")] == [DRIVE]
    assert client.of("sound") == [b"\x01\x00", b"\x02\x00"]
    outcomes = [event["item"] for event in server.talks[0].those("conversation.item.create")]
    assert [(item["call_id"], item["output"]) for item in outcomes] == [
        ("call-1", "Distance ahead: 2.00 m"),
        ("call-2", "accepted"),
    ]
    assert client.ledger.totals().tokens == 4 * 230


async def test_bad_commands_are_refused_and_told_to_the_model() -> None:
    bad = json.dumps({"thought": "go", "commands": [{**DRIVE, "speed": 5}]})

    async def script(talk: Talk) -> None:
        await talk.hears("go on")
        await talk.calls(ACT, bad, "call-1")
        await talk.calls("fly", GO, "call-2")
        await talk.got("response.create", 2)

    with RealtimeServer(script) as server:
        client = Client(server)
        async with talking(client):
            await until(lambda: server.talks and len(server.talks[0].those("response.create")) == 2, "both outcomes")
    assert not client.of("act")
    assert "must be from -0.5 to 0.5 m/s, not 5" in client.of("refused")[0]
    outputs = [event["item"]["output"] for event in server.talks[0].those("conversation.item.create")]
    assert outputs[0].startswith("refused, nothing was done")
    assert outputs[1] == "there is no function fly"


async def test_nothing_is_done_before_somebody_speaks_or_after_a_stop() -> None:
    """A model cannot act by itself; after a stop it waits for a voice again."""

    async def script(talk: Talk) -> None:
        await talk.calls(ACT, GO, "call-1")
        await talk.hears("go on")
        await talk.calls(ACT, GO, "call-2")
        await talk.got("response.cancel")
        await talk.calls(ACT, GO, "call-3")
        await talk.hears("go on")
        await talk.calls(ACT, GO, "call-4")
        await talk.got("conversation.item.create", 4)

    with RealtimeServer(script) as server:
        client = Client(server)
        async with talking(client):
            await until(lambda: len(client.of("act")) == 1, "the first that is done")
            await client.talk.stop()
            await until(lambda: len(server.talks[0].those("conversation.item.create")) == 4, "all outcomes")
    outcomes = {
        event["item"]["call_id"]: event["item"]["output"]
        for event in server.talks[0].those("conversation.item.create")
    }
    assert [outcomes[f"call-{n}"] == "accepted" for n in (1, 2, 3, 4)] == [False, True, False, True]
    assert len(client.of("act")) == 2


async def test_a_person_who_speaks_interrupts() -> None:
    async def script(talk: Talk) -> None:
        await talk.says(b"\x01\x00")
        await talk.hears("wait")

    with RealtimeServer(script) as server:
        client = Client(server)
        async with talking(client):
            await until(lambda: client.of("heard"), "the interruption")
    kinds = [kind for kind, _ in client.told]
    assert kinds.index("interrupted") > kinds.index("sound")


async def test_however_a_talk_ends_it_is_told() -> None:
    """Closed, failed, an error event, sound that is none, nobody there."""

    async def fails(talk: Talk) -> None:
        await talk.begins()
        error = {"type": "server_error", "code": "x", "message": f"overloaded {KEY}"}
        await talk.ends(status="failed", status_details={"type": "failed", "error": error})

    async def error(talk: Talk) -> None:
        await talk.send("error", error={"type": "invalid_request_error", "message": f"bad {KEY}"})

    async def no_sound(talk: Talk) -> None:
        await talk.begins()
        await talk.send("response.output_audio.delta", delta="!", response_id="r", item_id="i")

    async def deep(talk: Talk) -> None:
        await talk.text("[" * 200_000)

    async def no_event(talk: Talk) -> None:
        await talk.text("[1]")

    async def empty(talk: Talk) -> None:
        await talk.begins()
        await talk.send("response.done")

    cases = [
        (deep, FaultKind.NOT_AN_API, "cannot be read"),
        (no_event, FaultKind.NOT_AN_API, "cannot be read"),
        (empty, FaultKind.NOT_AN_API, "cannot be read"),
        (Talk.hang_up, FaultKind.CUT, "lost"),
        (fails, FaultKind.SERVER, "overloaded ***"),
        (error, FaultKind.SERVER, "bad ***"),
        (no_sound, FaultKind.NOT_AN_API, "cannot be read"),
    ]
    for script, kind, words in cases:
        with RealtimeServer(script) as server:
            fault = await Client(server).fault()
        assert fault.kind is kind
        assert words in str(fault)
    assert (await Client(server).fault()).kind is FaultKind.UNREACHABLE
