"""A profile, the form of a message and the value of a parameter read YAML alike."""

from __future__ import annotations

import math
from typing import Any

import pytest

from graph.calls.parameters_values import WrongValueError, carried
from graph.messages.yaml_reading import read_message
from launcher.profile.problems import Problems
from launcher.profile.reading import read_yaml
from text.yaml_faults import YamlError
from text.yaml_tree import plain

WORDS: list[tuple[str, object]] = [
    ("inf", math.inf),
    ("-.inf", -math.inf),
    ("0o17", 15),
    ("017", 15),
    ("0x1F", 31),
    ("1e3", 1000.0),
    ("1_000", 1000),
    ("1e400", "1e400"),
    ("12:30", "12:30"),
    ("2026-11-24", "2026-11-24"),
    ("on", True),
    ("'on'", "on"),
    ("two\u00a0words", "two\u00a0words"),
    ("'\u00a0in quotes\u00a0'", "\u00a0in quotes\u00a0"),
    ("~", None),
]
NBSP = "the character U+00A0 only looks like a space: write an ordinary one"
KINDS: dict[type, str] = {bool: "bool", int: "integer", float: "double"}
WRONG = [
    ("[1, 2", "this list is not closed: a ',' or a ']' is missing"),
    ("[1, ", "a value is missing here, or a ']' or '}'"),
    ("[1, 'x]", "the text in quotes is not closed"),
    ("[@a]", "nothing can begin with this character: put the text in quotes"),
    ("[\a]", "the character U+0007 is not allowed: remove it"),
    ("[{b: 1, b: 2}]", "'b' appears a second time, first on line 1: join them or rename one"),
    ("[!env x]", "the tag !env is refused: only plain values are read"),
    ("[{[b]: 1}]", "expected a name before the ':', found a list or a mapping"),
    ("[x]\n---", "a second document begins here, and only one is read"),
    ("[{b:[1]}]", "a space is missing after this ':'"),
    ("[\u00a0b]", NBSP),
    ("[{b\u00a0: 1}]", NBSP),
    ("[1\u202f# b\n]", "the character U+202F only looks like a space: write an ordinary one"),
    ('["\\q"]', "YAML does not know this \\ in double quotes: use single quotes"),
]


def in_profile(text: str) -> Any:
    problems = Problems()
    tree = read_yaml(f"a: {text}", "a.yaml", problems)
    for problem in problems.found:
        raise YamlError(problem.line, problem.column, problem.message)
    assert tree is not None
    return plain(tree)["a"]


def in_form(text: str) -> Any:
    return plain(read_message(f"a: {text}"))["a"]


@pytest.mark.parametrize(("text", "meant"), WORDS)
def test_a_word_stands_for_the_same_everywhere(text: str, meant: object) -> None:
    for found in (in_profile(text), in_form(text)):
        assert (type(found), found) == (type(meant), meant)


@pytest.mark.parametrize(("text", "meant"), [each for each in WORDS if type(each[1]) in KINDS])
def test_a_parameter_is_given_what_the_word_stands_for(text: str, meant: object) -> None:
    kind = KINDS[type(meant)]
    assert carried(kind, text)[f"{kind}_value"] == meant


@pytest.mark.parametrize("text", ["[inf, 0o17, 1e3]", "[.inf, 15, 1000.0]"])
def test_the_value_of_a_parameter_is_read_so_too(text: str) -> None:
    assert carried("double_array", text)["double_array_value"] == [math.inf, 15.0, 1000.0]


@pytest.mark.parametrize(("text", "words"), WRONG)
def test_what_is_wrong_is_told_in_the_same_words_at_the_same_place(text: str, words: str) -> None:
    places = set()
    for reading in (in_profile, in_form):
        with pytest.raises(YamlError) as caught:
            reading(text)
        assert caught.value.message == words
        places.add((caught.value.line, caught.value.column))
    assert len(places) == 1
    with pytest.raises(WrongValueError) as refused:
        carried("string_array", text)
    assert str(refused.value) == words


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("{x:0}", (1, 2), "a space is missing after the ':': x: 0"),
        ("linear: {x: 1, y:0.5}", (1, 16), "a space is missing after the ':': y: 0.5"),
        ("data:hello world", (1, 1), "a space is missing after the ':': data: hello world"),
        ("x:0\ny:1", (1, 1), "a space is missing after the ':': x: 0 y:1"),
        ('- {data:"x"}', (1, 4), "a space is missing after the ':': data: \"x\""),
        ("data:\u00a0hello", (1, 6), NBSP),
        ("linear:\n\u00a0 x: 1.0", (2, 1), NBSP),
        ("linear:\n  x: 1.0\n \u00a0y: 2.0", (3, 2), NBSP),
        ("x:\n  -\u00a0y", (2, 4), NBSP),
    ],
)
def test_a_space_that_is_none_is_told_in_a_message(
    text: str, place: tuple[int, int], words: str
) -> None:
    with pytest.raises(YamlError) as caught:
        read_message(text)
    assert ((caught.value.line, caught.value.column), caught.value.message) == (place, words)


@pytest.mark.parametrize("text", ["data: a:b", "data: http://x", "data: 'x:0'", "{'x:0': 1}"])
def test_a_colon_may_stand_in_a_value(text: str) -> None:
    assert len(read_message(text).entries) == 1
