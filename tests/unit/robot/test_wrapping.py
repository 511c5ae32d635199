"""What models make of JSON is read where that is sure, and places stay what they were."""

from __future__ import annotations

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.commands.problems import CommandError
from robot.commands.schema import LlmResponse, parse_llm, so_far
from robot.commands.wrapping import unwrapped

DRIVE = '{"action":"drive","speed":0.2,"steering":0.0}'
ANSWER = f'{{"thought":"go","commands":[{DRIVE}]}}'
BACK = ANSWER.replace("0.2", "-0.2")
SEVERAL = "more than one JSON object stands here: one alone is expected"
ONLY_THOUGHTS = "only thoughts (<think>) stand here: no JSON follows </think>"
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
        f"Fine, {{go}}: ```json\n{BACK}\n```\nor not?\n</think>\n\n{ANSWER}",
        f"<think>hm</think>Here you are:\n\n```json\n{ANSWER}\n```\nThis\u00a0drives *slowly*.",
        ANSWER.replace('"', "'"),
        f"```python\n{ANSWER.replace(chr(34), chr(39))}\n```",
        ANSWER.replace("}]}", ",}, ],\n}"),
        ANSWER.replace("0.2", "0.2 m/s").replace("0.0", "0.0rad"),
        ANSWER.replace("0.2", "0.2м/с").replace("0.0", "0.0 рад"),
    ],
)
def test_what_is_sure_is_read(text: str) -> None:
    assert parse_llm(text) == parse_llm(text.encode()) == parse_llm(ANSWER)
    assert so_far(text) == (1, ())


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
        (ANSWER.replace('"', "'").replace("go", "it's"), *(1, 12, "write straight double quotes (\") in place of '")),
        (f"```json\n{ANSWER}", 1, 1, "leave the code fence (```) out: the JSON alone is expected"),
        (f"{ANSWER}\n```", 2, 1, "leave the code fence (```) out: the JSON alone is expected"),
        (
            ANSWER.replace("0.2", "3 km/h"),
            *(1, ANSWER.index("0.2") + 3, "km/h stands behind 3; this field is in m/s"),
        ),
        (
            ANSWER.replace("0.2", "0.2 m/s²"),
            *(1, ANSWER.index("0.2") + 5, "m/s² stands behind 0.2; this field is in m/s"),
        ),
        (f"{ANSWER}\n{BACK}", 2, 1, SEVERAL),
        (f"{BACK}\n</think>\n{ANSWER}", 3, 1, SEVERAL),
        (f"```\n{BACK}\n```\nor\n```\n{ANSWER}\n```", 6, 1, SEVERAL),
        (f"Here: {ANSWER}", 1, 1, "leave the words before the JSON out"),
        (f"- {ANSWER}", 1, 1, "leave the words before the JSON out"),
        ("\n*Sorry*", 2, 1, "only words stand here: a JSON object is expected"),
        (f"<think>\n```json\n{ANSWER}\n```\n", 1, 1, ONLY_THOUGHTS),
        ("\nNow we are done.</think>\n", 2, 1, ONLY_THOUGHTS),
        (f"<think>a <think>b</think> {ANSWER}", *(1, 1, "leave <think> out: the JSON alone is expected")),
        (ANSWER.replace("0.2", "1e999"), 1, ANSWER.index("0.2") + 1, "1e999 is too large for a number"),
    ],
)
def test_what_is_not_sure_is_named_with_its_place(text: str, line: int, column: int, words: str) -> None:
    with pytest.raises(CommandError) as refused:
        parse_llm(text)
    problem = refused.value.problems[0]
    assert (problem.line, problem.column, problem.message) == (line, column, words)


def test_a_unit_is_told_in_both_languages() -> None:
    with pytest.raises(CommandError) as refused:
        parse_llm(ANSWER.replace("0.2", "3 км/ч"))
    words = refused.value.problems[0].in_language("ru")
    assert words == "после 3 стоит км/ч, а это поле — в м/с"


# --------------------------------------------- of two answers, never the one that was not meant

AROUND = ("<think>", "</think>", "```json\n", "\n```\n", "~~~", "\n", "Words: ", "{", "'", '"')
pieces = st.lists(st.sampled_from(AROUND), max_size=2).map("".join)


@given(pieces, st.permutations((ANSWER, BACK)), pieces | st.just("Words.</think>"), pieces)
def test_of_two_answers_only_the_one_behind_the_thoughts_is_taken(
    before: str, answers: list[str], between: str, after: str
) -> None:
    first, second = answers
    text = f"{before}{first}{between}{second}{after}"
    so_far(text)
    try:
        found = parse_llm(text)
    except CommandError:
        return
    assert "</think>" in between
    assert "think>" not in after
    assert found == parse_llm(second)


@given(
    st.lists(st.sampled_from((ANSWER, *AROUND)) | st.text(), max_size=4).map("".join),
    st.sampled_from(("{}", "\ufeff{}", "```json\n{}\n```", "Words.\n```{}```\nWords.", "x</think>{}")),
)
def test_a_thought_of_any_text_stays_what_it_is(thought: str, around: str) -> None:
    meant = LlmResponse(thought=thought, commands=parse_llm(ANSWER).commands)
    plain = meant.model_dump_json()
    assert parse_llm(plain) == meant
    for text in (plain, str(meant.model_dump())):
        with contextlib.suppress(CommandError):
            assert parse_llm(around.replace("{}", text)) == meant
