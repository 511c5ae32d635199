"""An answer is checked here whatever the server promised, and repaired once at most."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import pytest

from brain.faults import FaultKind, ModelError
from brain.ladder import Ladder
from brain.looking import look, parse_seen
from brain.situation import LONGEST_HEARD, Memory, Situation, conversation
from brain.thinking import think
from robot.commands.problems import CommandError
from robot.commands.schema import SpokenResponse, parse_llm
from robot.motion.odometry import Pose
from tests.model_server import ModelServer, obeys, rung_of
from tests.unit.brain.asking import HELLO, client_of

if TYPE_CHECKING:
    from pathlib import Path

    from brain.thinking import Thought
    from tests.model_server import Exchange

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
        is_probe = "enum" in json.dumps(exchange.request) and "deck-" in json.dumps(
            exchange.request
        )
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


def test_the_spoken_form_obeys_the_rules_of_strict_output() -> None:
    """Every field required, nothing more allowed, no oneOf and no defaults."""
    for schema in (SCHEMA, *SCHEMA["$defs"].values()):
        assert schema["additionalProperties"] is False
        assert schema["required"] == list(schema["properties"])
    assert "oneOf" not in json.dumps(SCHEMA)
    assert "default" not in json.dumps(SCHEMA)


def test_the_model_is_told_what_the_senses_say() -> None:
    """Unknown, invalid and out of range are three different things."""
    situation = Situation(
        "go on",
        1.234,
        math.nan,
        Pose(1, -2, math.pi / 2),
        "forward is blocked",
        "refused: too fast",
        "a wall",
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
    for distance, words in (
        (None, "unknown"),
        (math.inf, "nothing in range"),
        (-math.inf, "too close"),
    ):
        assert words in Situation("", distance).message()["content"]


def test_a_picture_goes_inside_the_message() -> None:
    text, picture = Situation("look", picture=b"\xff\xd8jpeg").message()["content"]
    assert "look" in text["text"]
    assert picture["image_url"]["url"] == "data:image/jpeg;base64,/9hqcGVn"


def test_the_memory_is_bounded() -> None:
    """In turns and in characters; the newest turn is always kept."""
    memory = Memory(turns=3, characters=100)
    for number in range(5):
        memory.add(f"word {number}", "{}")
    assert [message["content"] for message in memory.messages()][::2] == [
        f'Somebody says: "word {number}"' for number in (2, 3, 4)
    ]
    memory.add("x" * 10_000, "{}")
    assert len(memory.messages()) == 2
    assert len(memory.messages()[0]["content"]) < LONGEST_HEARD + 50
    memory.forget()
    assert memory.messages() == []


async def test_a_picture_is_described_with_boxes(tmp_path: Path) -> None:
    box = {"left": 0.1, "top": 0.2, "right": 0.5, "bottom": 0.9}
    seen = {
        "description": " A cup. ",
        "things": [{"label": "cup", "box": box}, {"label": "table", "box": None}],
    }
    with ModelServer(Answers(json.dumps(seen))) as server:
        async with client_of(server) as client:
            found = (await look(Ladder(client, "m-1", tmp_path), "Describe.", b"\xff\xd8")).value
        sent = server.exchanges[-1].request
        assert rung_of(sent) is not None
        assert sent["messages"][-1]["content"][0]["type"] == "image_url"
    assert found.description == "A cup."
    assert found.things[0].box is not None
    assert found.things[0].box.right == 0.5


def _with_a_box(left: float = 0, right: float = 1) -> str:
    box = {"left": left, "top": 0, "right": right, "bottom": 1}
    return json.dumps({"description": "x", "things": [{"label": "cup", "box": box}]})


@pytest.mark.parametrize(
    "text",
    [
        "A cup.",
        "[" * 100_000,
        '{"description": "x"}',
        _with_a_box(right=7),
        _with_a_box(left=1, right=0),
        '{"description": NaN, "things": []}',
    ],
)
def test_what_describes_no_picture_is_refused(text: str) -> None:
    with pytest.raises(CommandError):
        parse_seen(text)


def test_what_stands_in_place_of_a_description_is_named() -> None:
    with pytest.raises(CommandError, match=r"^2:1: only words stand here"):
        parse_seen("\nA cup.")
