"""Texts from elsewhere are read to a depth, and to no RecursionError."""

from __future__ import annotations

import pytest
import yaml

from text.nested import MAX_DEPTH, NestedTooDeeplyError, read_json
from text.nested_yaml import read_yaml


@pytest.mark.parametrize("opening", ["[", '{"a":', '[{"a":'])
@pytest.mark.parametrize("times", [MAX_DEPTH + 1, 900, 200_000])
def test_what_is_nested_without_end_is_refused(opening: str, times: int) -> None:
    closing = opening.replace('"a":', "")[::-1].translate(str.maketrans("[{", "]}"))
    text = opening * times + "1" + closing * times
    for form in (text, text.encode()):
        with pytest.raises(ValueError, match="nested deeper than 64 levels"):
            read_json(form)
    with pytest.raises(
        (NestedTooDeeplyError, yaml.YAMLError), match=r"nested deeper|nesting depth"
    ):
        read_yaml(opening.replace(":", ": ") * times + "1" + closing * times)


def test_what_is_broad_or_full_of_brackets_is_read() -> None:
    assert read_json("[" + "[]," * 500 + "[]]") == [[]] * 501
    assert read_json('["' + "[" * 500 + '"]') == ["[" * 500]
    deep = "[" * MAX_DEPTH + "]" * MAX_DEPTH
    assert str(read_json(deep)) == str(read_yaml(deep)) == deep
    assert read_yaml("a: [1, {b: c}]") == {"a": [1, {"b": "c"}]}


def test_what_is_none_is_told_as_ever() -> None:
    with pytest.raises(ValueError, match="Expecting value"):
        read_json("")
    with pytest.raises(yaml.YAMLError):
        read_yaml("[")
