"""JSON with places: the same values as the standard parser, and the place of each."""

from __future__ import annotations

import ast
import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.commands.json_places import JsonError, line_column, read

documents = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**17), 10**17)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(st.characters(exclude_categories=["Cs"])),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=12,
)


@given(documents, st.sampled_from([None, 1]), st.booleans())
def test_reads_what_the_standard_parser_reads(document: object, indent: int | None, ascii_only: bool) -> None:
    text = json.dumps(document, indent=indent, ensure_ascii=ascii_only)
    assert read(text).value == json.loads(text)


@given(st.text(max_size=18) | st.text("[]{}\"',:1e.-+NoneTrux\\ \n", max_size=18))
def test_what_neither_json_nor_python_reads_is_refused(text: str) -> None:
    try:
        found = read(text)
    except JsonError as error:
        assert 0 <= error.offset <= len(text)  # noqa: PT017 - both outcomes are right
        return
    try:
        expected = json.loads(text)
    except ValueError:
        expected = ast.literal_eval(text.strip())
    assert found.value == expected


@given(documents)
def test_what_python_writes_is_read_as_it_was_meant_or_not_at_all(document: object) -> None:
    text = repr(document)
    try:
        found = read(text)
    except JsonError as error:
        assert error.code == "string_bad"  # noqa: PT017 - JSON has fewer escapes
        assert re.search(r"\\x|\\U", text)
    else:
        assert found.value == document


def test_the_place_of_a_value_is_where_it_begins() -> None:
    text = '{\n  "a": [1, {"б": "x"}]\n}'
    found = read(text)
    assert text[found.values[("a", 1, "б")] :].startswith('"x"')
    assert text[found.keys[("a", 1, "б")] :].startswith('"б"')
    assert line_column(text, found.values[("a", 1, "б")]) == (2, 18)


def test_a_comma_between_two_numbers_of_a_list_is_no_decimal_comma() -> None:
    assert read("[0,5]").value == [0, 5]


@pytest.mark.parametrize(
    ("text", "code", "offset"),
    [
        ("", "nothing", 0), (" ", "nothing", 1), ("[", "value_expected", 1),
        ("{", "key_expected", 1), ('{"a" 1}', "colon_expected", 5), ("[1 2]", "comma_expected", 3),
        ("[,]", "other_expected", 1), ("[1,,]", "other_expected", 3), ("[1e999]", "too_large", 1),
        ("[-1e999]", "too_large", 1), ("9" * 400, "too_large", 0), ('{“a": 1}', "quotes", 1),
        ("{'a': 'it's'}", "quotes", 6), ("['\\x41']", "string_bad", 1), ("['a' 'b']", "quotes", 1),
        ("[«a»]", "quotes", 1), ("Here: ```json\n{}\n```", "words_before", 0),
        (" Вот: {}", "words_before", 1), ("**Now**: {}", "words_before", 0), ("Sorry.", "words", 0),
        ("{}, {}", "several", 4), ("{} <think>", "tag", 3), ("```json\n{}", "fence", 0),
        ("{}\n```", "fence", 3), ('"abc', "string_bad", 0), ('"a\nb"', "string_bad", 2),
        ("NaN", "not_finite", 0), ("[-Infinity]", "not_finite", 1), ("01", "number_form", 0),
        ("[+1]", "number_form", 1), ("[.5, 1]", "number_form", 1), ("[-.5]", "number_form", 1),
        ("[2.]", "number_form", 1), ("[0x1F]", "number_form", 1), ("[TRUE]", "constant", 1),
        ('{"a": nULL}', "constant", 6), ("[undefined]", "constant", 1),
        ("[nilly]", "other_expected", 1), ("[1, ...]", "other_expected", 4),
        ("[1, // x\n2]", "comment", 4),
        ("[1 /* x */]", "comment", 3), ("{} # x", "comment", 3), ("[1\u00a0]", "invisible", 2),
        ("\u200b[]", "invisible", 0), ("[1\x00]", "invisible", 2), ("[1，2]", "alike", 2),
        ('{"a"：1}', "alike", 4), ("[−1]", "alike", 1), ("~~~json\n{}", "fence", 0),
        ('{\\"a\\": 1}', "backslash", 1), ('{"a": 0,5}', "decimal_comma", 6),
        ("-1,25", "decimal_comma", 0), ('{"a":1,"a":2}', "duplicate", 7),
        ('"\\ud800"', "half_character", 0), ("[" * 60_000, "too_deep", 33),
    ],
)  # fmt: skip
def test_each_fault_has_its_code_and_place(text: str, code: str, offset: int) -> None:
    with pytest.raises(JsonError) as caught:
        read(text)
    assert (caught.value.code, caught.value.offset) == (code, offset)
