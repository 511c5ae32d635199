"""YAML with places: what it means, what is refused and where, and how deep it may be."""

from __future__ import annotations

import math
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from graph.calls.parameters import carried
from graph.messages.making import FieldError
from graph.messages.yaml_text import read_message
from launcher.profile.reading import Problems
from launcher.profile.reading import read_yaml as read_profile
from text.nested import MAX_DEPTH, NestedTooDeeplyError, read_json
from text.nested_yaml import read_yaml
from text.yaml_faults import YamlError
from text.yaml_tree import Branch, FilePlace, Rules, field_name, find, mapping, place_of, plain, read

STRICT = Rules(shares=False, longest=1024 * 1024, deepest=64)
SHARING = Rules(shares=True, longest=1024 * 1024, deepest=24, most=1000)


def fields(text: str, rules: Rules = STRICT) -> Branch:
    root = read(text, rules)
    assert root is not None
    return mapping(root)


def meant(text: str) -> object:
    """Read the only value of a mapping."""
    return plain(fields(f"a: {text}", SHARING))["a"]


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("on", True), ("No", False), ("y", "y"), ("1e3", 1000.0), ("-.5e-1", -0.05), ("0o17", 15),
        ("017", 15), ("09", "09"), ("0x1F", 31), ("1_000", 1000), ("12:30", "12:30"),
        ("2026-01-01", "2026-01-01"), ("~", None), ("", None), ("inf", math.inf),
        ("-.inf", -math.inf), ("1e400", "1e400"), ("'on'", "on"), ('"5"', "5"),
        ("!!str 5", "5"), ("!!int 0o17", 15), ("!!int '5'", 5), ("!!float 5", 5.0),
        ("!!bool 'yes'", True), ("!!null ~", None), ("=", "="), ("<<", "<<"),
        ("9" * 2000, "9" * 2000),
    ],
)  # fmt: skip
def test_words_mean_what_a_ros_user_expects(word: str, value: object) -> None:
    found = meant(word)
    assert found == value
    assert type(found) is type(value)


def test_nan_is_a_number() -> None:
    for word in ("nan", ".nan", "NaN"):
        found = meant(word)
        assert isinstance(found, float)
        assert math.isnan(found)


def test_a_key_is_a_word_whatever_it_looks_like() -> None:
    assert plain(fields("on: 1\n017: 2\n~: 3\n'a b': 4")) == {"on": 1, "017": 2, "~": 3, "a b": 4}


def test_nothing_is_no_tree() -> None:
    assert read("# nothing\n", STRICT) is None


def test_everything_has_its_place() -> None:
    tree = read("a:\n- x\n- {b: 1}\n", STRICT, "a.yaml")
    assert tree is not None
    places = {
        field_name(where): (place_of(tree, where), place_of(tree, where, key=True))
        for where in [("a",), ("a", 0), ("a", 1), ("a", 1, "b"), ("a", 1, "c")]
    }
    assert places == {
        "a": (FilePlace("a.yaml", 2, 1), FilePlace("a.yaml", 1, 1)),
        "a[0]": (FilePlace("a.yaml", 2, 3), FilePlace("a.yaml", 2, 3)),
        "a[1]": (FilePlace("a.yaml", 3, 3), FilePlace("a.yaml", 3, 3)),
        "a[1].b": (FilePlace("a.yaml", 3, 7), FilePlace("a.yaml", 3, 4)),
        "a[1].c": (FilePlace("a.yaml", 3, 3), FilePlace("a.yaml", 3, 3)),
    }
    assert find(tree, ("a", 2)) is None


def test_an_alias_stands_for_its_value_and_its_place() -> None:
    tree = fields("a: &x [1, {b: 2}]\nc: *x", SHARING)
    assert plain(tree) == {"a": [1, {"b": 2}], "c": [1, {"b": 2}]}
    assert place_of(tree, ("c",)) == FilePlace("", 1, 4)


def test_an_anchor_on_a_key_remembers_what_its_word_means() -> None:
    assert plain(fields("&x on: 1\nb: *x", SHARING)) == {"on": 1, "b": True}


def test_what_is_merged_gives_way_to_what_is_written() -> None:
    text = "a: &a {x: 1, y: 1}\nb: &b {y: 2, z: 2}\nc: {<<: [*a, *b], x: 3}"
    assert plain(fields(text, SHARING))["c"] == {"x": 3, "y": 1, "z": 2}


@pytest.mark.parametrize(
    ("text", "rules"), [("'<<': {a: 1}", SHARING), ("<<: {a: 1}", STRICT)], ids=["quoted", "strict"]
)
def test_a_key_like_any_other_merges_nothing(text: str, rules: Rules) -> None:
    assert plain(fields(text, rules)) == {"<<": {"a": 1}}


REFUSED_EVERYWHERE = [
    ("[1]", 1, 1, "expected `name: value`, found a list"),
    ("5", 1, 1, "expected `name: value`, found a single value"),
    ("~", 1, 1, "expected `name: value`, found nothing"),
    ("a: 1\nb: 2\na: 3", 3, 1, "'a' appears a second time, first on line 1: join them or rename one"),
    ("x:\n  {a: 1, a: 2}", 2, 10, "second time, first on line 2"),
    ("a: 1\n---\nb: 2", 2, 1, "a second document begins here, and only one is read"),
    ("a:\n\tb: 1", 2, 1, "this line is indented with a tab"),
    ("b: 1\na: [1, 2", 2, 4, "this list is not closed"),
    ("a:\n  b: {c: [x}", 2, 10, "this list is not closed"),
    ("a: [1,\n\n", 1, 7, "a value is missing here"),
    ("a: [", 1, 5, "a value is missing here, or a ']' or '}'"),
    ("a: {b: 1", 1, 4, "these braces are not closed"),
    ("a: {b: {c: [x]}", 1, 4, "these braces are not closed: a ',' or a '}' is missing"),
    ('a: "x\nb: 3', 1, 4, "the text in quotes is not closed"),
    ('a:\n  b: {c: ["x]}', 2, 11, "the text in quotes is not closed"),
    ("a: b: c", 1, 5, "a second ':' in one line: put the text that holds it in quotes"),
    ("a\nb: 1", 2, 2, "does not fit the one above"),
    ("a:\n  b\n    c: [x]", 3, 6, "a ':' is missing there, or the indentation differs"),
    ("x: 1.0\ny:2.0\nz: 0.0", 2, 1, "or a space after it"),
    ("x: 1.0\ny", 2, 1, "a ':' is missing after the name of the field"),
    ("a: @x", 1, 4, "nothing can begin with this character: put the text in quotes"),
    ('a: "C:\\dir"', 1, 7, "YAML does not know this \\ in double quotes: use single quotes"),
    ("a: - b", 1, 4, "a list cannot begin here: put it on a line of its own"),
    ("a: >b\nc: d", 1, 5, "not YAML: did not"),
    ("a:\n    b: 1\n  c: 2", 3, 3, "the indentation does not fit"),
    ("a: !!python/object:os.x 1", 1, 4, "the tag !!python/object:os.x is refused: only plain"),
    ("a: !env HOME", 1, 4, "the tag !env is refused: only plain values are read"),
    ("a: !!seq b", 1, 4, "the tag !!seq is refused"),
    ("a: !!map [b]", 1, 4, "the tag !!map is refused"),
    ("a: !!int 1.5", 1, 4, "'1.5' is not a valid int"),
    ("a: !!float x", 1, 4, "'x' is not a valid float"),
    ("a: !!bool 1", 1, 4, "'1' is not a valid bool"),
    ("a: !!null x", 1, 4, "'x' is not a valid null"),
    ("a: b\x07", 1, 5, "the character U+0007 is not allowed"),
    ("a: \ud800", 1, 4, "the character U+D800 is not allowed"),
    ("? [a]\n: 1", 1, 3, "expected a name before the ':', found a list or a mapping"),
    ("a: " + "я" * 600_000, 1, 1, "is longer than 1024 KiB"),
]
REFUSED_WHERE_NOTHING_IS_SHARED = [
    ("a: &x 1", 1, 4, "anchors and aliases are refused: write the value out"),
    ("a: *x", 1, 4, "anchors and aliases are refused: write the value out"),
    ("a: " + "[" * 100 + "]" * 100, 1, 67, "is nested deeper than 64 levels"),
]
REFUSED_OF_WHAT_IS_SHARED = [
    ("a: &x {b: *x}", 1, 4, "contains itself, by an alias"),
    ("a: *x", 1, 4, "this alias refers to nothing: there is no such anchor before it"),
    ("a: &x 1\nb: &x 2", 2, 4, "there is an anchor of this name already"),
    ("a: {<<: 1}", 1, 5, "expected a mapping to merge"),
    ("a: " + "[" * 100 + "]" * 100, 1, 27, "is nested deeper than 24 levels"),
    ("a: &x [" + "1," * 500 + "]\nb: *x", 1, 4, "has more than 1000 values, counting aliases"),
]


@pytest.mark.parametrize(
    ("text", "line", "column", "words", "rules"),
    [
        *((*case, STRICT) for case in REFUSED_EVERYWHERE + REFUSED_WHERE_NOTHING_IS_SHARED),
        *((*case, SHARING) for case in REFUSED_EVERYWHERE + REFUSED_OF_WHAT_IS_SHARED),
    ],
    ids=lambda value: value[:20] if isinstance(value, str) else None,
)
def test_what_is_refused_tells_its_place(text: str, line: int, column: int, words: str, rules: Rules) -> None:
    with pytest.raises(YamlError) as raised:
        fields(text, rules)
    assert words in raised.value.message
    assert (raised.value.line, raised.value.column) == (line, column)
    assert str(raised.value) == f"{line}:{column}: {raised.value.message}"


@pytest.mark.parametrize(("rules", "words"), [(STRICT, "anchors"), (SHARING, "more than 1000")])
def test_a_bomb_of_aliases_does_not_go_off(rules: Rules, words: str) -> None:
    lines = ["a0: &a0 [x, x]"]
    lines += [f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]" for n in range(1, 40)]
    with pytest.raises(YamlError, match=words):
        fields("\n".join(lines), rules)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(
    st.text(max_size=60) | st.text("ab:-[]{}'\"#&*!|>%@`\t\n ,?0.<", max_size=40), st.sampled_from([STRICT, SHARING])
)
def test_any_text_is_a_tree_or_an_error_with_a_place(text: str, rules: Rules) -> None:
    place = (1, 1)
    try:
        tree = read(text, rules)
        assert tree is None or plain(tree) is not tree
    except YamlError as error:
        place = (error.line, error.column)
    assert 1 <= place[0] <= text.count("\n") + 2
    assert place[1] >= 1


ENDS = "the character U+2028 ends a line here: write an ordinary end of line"
WIDE = "the character U+FF1A only looks like ':': write an ordinary one"
NBSP = "the character U+00A0 only looks like a space: write an ordinary one"
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
    tree = read_profile(f"a: {text}", "a.yaml", problems)
    for problem in problems.found:
        raise YamlError(problem.line, problem.column, problem.message)
    assert tree is not None
    return plain(tree)["a"]


def in_form(text: str) -> Any:
    return plain(read_message(f"a: {text}"))["a"]


@pytest.mark.parametrize(("text", "words"), WRONG)
def test_what_is_wrong_is_told_in_the_same_words_at_the_same_place(text: str, words: str) -> None:
    places = set()
    for reading in (in_profile, in_form):
        with pytest.raises(YamlError) as caught:
            reading(text)
        assert caught.value.message == words
        places.add((caught.value.line, caught.value.column))
    assert len(places) == 1
    with pytest.raises(FieldError) as refused:
        carried("string_array", text)
    assert str(refused.value) == words


@pytest.mark.parametrize("opening", ["[", '{"a":', '[{"a":'])
@pytest.mark.parametrize("times", [MAX_DEPTH + 1, 900, 200_000])
def test_what_is_nested_without_end_is_refused(opening: str, times: int) -> None:
    closing = opening.replace('"a":', "")[::-1].translate(str.maketrans("[{", "]}"))
    text = opening * times + "1" + closing * times
    for form in (text, text.encode()):
        with pytest.raises(ValueError, match="nested deeper than 64 levels"):
            read_json(form)
    with pytest.raises((NestedTooDeeplyError, yaml.YAMLError), match=r"nested deeper|nesting depth"):
        read_yaml(opening.replace(":", ": ") * times + "1" + closing * times)


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
        ("- x:0", (1, 3), "a space is missing after the ':': x: 0"),
        ("data :hello", (1, 1), "a space is missing after the ':': data: hello"),
        ("data:\n-1.0\n-2.0", (2, 1), "a space is missing after this '-', or a ':' in this line"),
        ("x: 1\u200b", (1, 5), "the character U+200B is invisible: remove it"),
        ("x: 1\u200e", (1, 5), "the character U+200E is invisible: remove it"),
        ("{\ufeffx: 1}", (1, 2), "the character U+FEFF is invisible: remove it"),
        ("\u202ax: 1", (1, 1), "the character U+202A is invisible: remove it"),
        ("{x: 1\u2028y: 1}", (1, 6), ENDS),
        ("a: 'b\u2028c'\nx: b\u2028c", (3, 5), ENDS),
        ("data\uff1a hello", (1, 5), WIDE),
        ("{x\uff1a 1.0}", (1, 3), WIDE),
        ("{linear\uff1a{x: 1.0}}", (1, 8), WIDE),
    ],
)
def test_a_space_that_is_none_is_told_in_a_message(text: str, place: tuple[int, int], words: str) -> None:
    with pytest.raises(YamlError) as caught:
        read_message(text)
    assert ((caught.value.line, caught.value.column), caught.value.message) == (place, words)


@pytest.mark.parametrize("text", ["שלום\u200f", "👩\u200d🔧", "你好：世界", "'a\u200b'", "−5", "'x\u2028y'"])
def test_what_a_text_may_hold_is_left_as_it_is(text: str) -> None:
    assert plain(read_message(f"data: {text}"))["data"] == text.strip("'")


@pytest.mark.parametrize("text", ["data: a:b", "data: http://x", "data: 'x:0'", "{'x:0': 1}"])
def test_a_colon_may_stand_in_a_value(text: str) -> None:
    assert len(read_message(text).entries) == 1
