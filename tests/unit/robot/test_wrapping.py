"""What models put around their JSON goes where that is sure, and places stay what they were."""

from __future__ import annotations

import pytest

from robot.commands.problems import CommandError
from robot.commands.schema import parse_llm
from robot.commands.so_far import so_far
from robot.commands.wrapping import unwrapped

DRIVE = '{"action":"drive","speed":0.2,"steering":0.0}'
ANSWER = f'{{"thought":"go","commands":[{DRIVE}]}}'
CURLY = ANSWER.replace('"', "“")


@pytest.mark.parametrize(
    "text",
    [
        f"\ufeff{ANSWER}",
        f"```json\n{ANSWER}\n```",
        f"```JSON {ANSWER} ```\n\n",
        f"```json{ANSWER}```",
        f"```\n{ANSWER}```",
        f"~~~json\n{ANSWER}\n~~~",
        f"\ufeff<think>{{hm}} ```x``` </think>\n```json\n{ANSWER}\n```",
        CURLY,
        ANSWER.replace('{"', "{„").replace('"', "”"),
        f"```json\n{CURLY}\n```",
    ],
)
def test_what_is_around_is_taken_away(text: str) -> None:
    assert parse_llm(text) == parse_llm(text.encode()) == parse_llm(ANSWER)
    assert so_far(text) == (1, ())


@pytest.mark.parametrize("fence", ["```", "~~~"])
def test_what_streams_in_a_fence_is_no_mistake(fence: str) -> None:
    begun = f"{fence}json\n{ANSWER}"
    for length in range(len(begun)):
        assert so_far(begun[:length])[1] == (), begun[:length]


def test_a_place_is_that_of_the_text_as_it_came() -> None:
    text = "```json\n" + ANSWER.replace("0.2", "9") + "\n```"
    with pytest.raises(CommandError) as refused:
        parse_llm(text)
    (problem,) = refused.value.problems
    assert (problem.line, problem.column) == (2, ANSWER.index("0.2") + 1)
    assert len(unwrapped(text)) == len(text)


@pytest.mark.parametrize(
    ("text", "line", "column", "words"),
    [
        (ANSWER.replace('"go"', "“go“"), 1, 12, 'write straight double quotes (") in place of “'),
        (ANSWER.replace('"', "'"), 1, 2, "write straight double quotes (\") in place of '"),
        (f"```json\n{ANSWER}", 1, 1, "leave the code fence (```) out: the JSON alone is expected"),
        (f"{ANSWER}\n```", 2, 1, "leave the code fence (```) out: the JSON alone is expected"),
        (
            ANSWER.replace("0.0}", "0.0,}"),
            1,
            ANSWER.index("0.0}") + 4,
            "no comma may stand before the closing }: remove it",
        ),
        (
            ANSWER.replace("0.2", "1e999"),
            1,
            ANSWER.index("0.2") + 1,
            "1e999 is too large for a number",
        ),
    ],
)
def test_what_is_not_sure_is_named_with_its_place(
    text: str, line: int, column: int, words: str
) -> None:
    with pytest.raises(CommandError) as refused:
        parse_llm(text)
    problem = refused.value.problems[0]
    assert (problem.line, problem.column, problem.message) == (line, column, words)
