"""What a model is asked, in which form, and what is taken of its answer."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from brain.faults import FaultKind, ModelError
from brain.ladder import Ladder, Rung
from brain.looking import parse_seen
from brain.situation import Memory, Situation, conversation
from brain.thinking import Thought, think
from robot.commands.problems import CommandError
from robot.commands.schema import LlmResponse, SpokenResponse, parse_llm
from robot.motion.odometry import Pose
from tests.model_server import Exchange, ModelServer, obeys, rung_of
from tests.unit.brain.asking import HELLO, client_of

SCHEMA = SpokenResponse.model_json_schema()
DRIVE = {"action": "drive", "speed": 0.2, "steering": 0.0}
GOOD = json.dumps({"thought": "clear", "commands": [DRIVE], "say": "I drive."})
FAST = json.dumps({"thought": "go", "commands": [{**DRIVE, "speed": 5}], "say": ""})


def spoken(text: str) -> SpokenResponse:
    return parse_llm(text, SpokenResponse)


class Answers:
    """A server that obeys, and gives these answers one after the other."""

    def __init__(self, *answers: str) -> None:
        self.left = list(answers)

    def __call__(self, exchange: Exchange) -> None:
        is_probe = "enum" in json.dumps(exchange.request) and "deck-" in json.dumps(exchange.request)
        (obeys("") if is_probe else obeys(self.left.pop(0)))(exchange)


async def thought_of(tmp_path: Path, *answers: str) -> tuple[Thought[SpokenResponse], ModelServer]:
    with ModelServer(Answers(*answers)) as server:
        async with client_of(server) as client:
            ladder = Ladder(client, "m-1", tmp_path)
            return await think(ladder, SCHEMA, HELLO, spoken), server


async def test_a_good_answer_is_taken_as_it_is(tmp_path: Path) -> None:
    thought, server = await thought_of(tmp_path, GOOD)
    assert thought.value.say == "I drive."
    assert thought.value.silent().model_dump() == {"thought": "clear", "commands": [DRIVE]}
    assert len(thought.usages) == 1
    assert len(server.exchanges) == 2


async def test_a_bad_answer_is_repaired_with_the_words_of_the_check(tmp_path: Path) -> None:
    """The model gets its own answer back, and what is wrong with it, by place and range."""
    thought, server = await thought_of(tmp_path, FAST, GOOD)
    assert thought.value.commands[0].model_dump() == DRIVE
    assert len(thought.usages) == 2
    *_, answered, asked = server.exchanges[-1].request["messages"]
    assert answered == {"role": "assistant", "content": FAST}
    assert "commands[0].speed: must be from -0.5 to 0.5 m/s, not 5" in asked["content"]


async def test_a_second_bad_answer_is_the_end(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"nor is the second: .*must be from -0\.5") as raised:
        await thought_of(tmp_path, GOOD[:-9], FAST)
    assert raised.value.kind is FaultKind.SHAPE


def test_the_model_is_told_what_the_senses_say() -> None:
    """Unknown, invalid and out of range are three different things."""
    situation = Situation(
        "go on", 1.234, math.nan, Pose(1, -2, math.pi / 2), "forward is blocked", "refused: too fast", "a wall"
    )
    *_, message = conversation("Be careful.", Memory(), situation)
    assert message["content"].splitlines() == [
        "Distance ahead: 1.23 m",
        "Distance behind: no valid reading",
        "Position: x 1.00 m, y -2.00 m, heading 90 deg, + is left",
        "Safety gate: forward is blocked",
        "Your last commands: refused: too fast",
        "Camera: a wall",
        'Somebody says: "go on"',
    ]
    for distance, words in ((None, "unknown"), (math.inf, "nothing in range"), (-math.inf, "too close")):
        assert words in Situation("", distance).message()["content"]


def _with_a_box(left: float = 0, right: float = 1) -> str:
    box = {"left": left, "top": 0, "right": right, "bottom": 1}
    return json.dumps({"description": "x", "things": [{"label": "cup", "box": box}]})


@pytest.mark.parametrize(
    "text",
    [
        "A cup.", "[" * 100_000, '{"description": "x"}', _with_a_box(right=7),
        _with_a_box(left=1, right=0), '{"description": NaN, "things": []}',
    ],
)  # fmt: skip
def test_what_describes_no_picture_is_refused(text: str) -> None:
    with pytest.raises(CommandError):
        parse_seen(text)


def test_what_stands_in_place_of_a_description_is_named() -> None:
    with pytest.raises(CommandError, match=r"^2:1: only words stand here"):
        parse_seen("\nA cup.")


SCHEMA_LADDER = LlmResponse.model_json_schema()
ANSWER = '{"thought": "clear", "commands": []}'


def refusing(*rungs: Rung) -> object:
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
            assert (await ladder.ask(SCHEMA_LADDER, HELLO)).text == ANSWER
        tried = [rung_of(exchange.request) for exchange in server.exchanges]
        assert tried == [*list(Rung)[: list(Rung).index(rung) + 1], rung]
        for exchange in server.exchanges:
            assert not ("response_format" in exchange.request and "tools" in exchange.request)


async def test_a_server_that_changed_is_asked_again(tmp_path: Path) -> None:
    """After a 400 to the known way the question fails, and the next one finds out anew."""
    with ModelServer(obeys(ANSWER, Rung.STRICT)) as server:
        async with client_of(server) as client:
            ladder = Ladder(client, "m-1", tmp_path)
            await ladder.rung()
            server.script = refusing(Rung.STRICT)  # type: ignore[assignment]
            with pytest.raises(ModelError) as raised:
                await ladder.ask(SCHEMA_LADDER, HELLO)
            assert raised.value.kind is FaultKind.REQUEST
            assert (await ladder.ask(SCHEMA_LADDER, HELLO)).text == ANSWER


async def test_a_server_that_obeys_nothing_is_told(tmp_path: Path) -> None:
    with ModelServer(lambda exchange: exchange.says("Hello! How can I help?")) as server:
        async with client_of(server) as client:
            with pytest.raises(ModelError, match="gives no answers in the form") as raised:
                await Ladder(client, "m-1", tmp_path).ask(SCHEMA_LADDER, HELLO)
    assert raised.value.kind is FaultKind.SHAPE
