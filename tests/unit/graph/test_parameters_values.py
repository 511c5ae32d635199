"""Values of parameters by their types, as a person types them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from graph.calls.parameters_values import TYPES, WrongValueError, carried, plain


@pytest.mark.parametrize(
    ("kind", "value", "made"),
    [
        ("double", 2, 2.0),
        ("double", " 1e3 ", 1000.0),
        ("double", "-.inf", float("-inf")),
        ("double", "0x10", 16.0),
        ("double", "017", 15.0),
        ("double", "Inf", float("inf")),
        ("integer", "0x10", 16),
        ("integer", "017", 15),
        ("integer", "0o17", 15),
        ("integer", "1e3", 1000),
        ("integer", " -1_000 ", -1000),
        ("integer", 3.0, 3),
        ("bool", "Yes", True),
        ("bool", False, False),
        ("string", "5", "5"),
        ("string", "", ""),
        ("double_array", "[1, 2.5]", [1.0, 2.5]),
        ("double_array", [], []),
        ("integer_array", np.array([1, 2]), [1, 2]),
        ("string_array", "[a, 'b c']", ["a", "b c"]),
        ("bool_array", [True, "off"], [True, False]),
        ("byte_array", [0, 255], b"\x00\xff"),
        ("byte_array", b"ab", b"ab"),
    ],
)
def test_what_fits_a_type_is_taken(kind: str, value: Any, made: Any) -> None:
    tree = carried(kind, value)
    assert tree == {"type": TYPES.index(kind), f"{kind}_value": made}
    assert type(tree[f"{kind}_value"]) is type(made)


@pytest.mark.parametrize(
    ("kind", "value", "words"),
    [
        ("double", "fast", "expected a number, got 'fast'"),
        ("double", "0,5", "write a fraction with a point: 0.5"),
        ("double", True, "expected a number, got True"),
        ("double", [1.0], "expected a number"),
        ("double", "1e400", "expected a number, got '1e400'"),
        ("double", "true", "expected a number, got 'true'"),
        ("double", "", "expected a number, got ''"),
        ("double", 10**400, "is too large for a double"),
        ("integer", 1.5, "expected a whole number, got 1.5"),
        ("integer", "1.5", "expected a whole number"),
        ("integer", float("inf"), "expected a whole number, got inf"),
        ("integer", "on", "expected a whole number, got 'on'"),
        ("integer", "~", "expected a whole number, got '~'"),
        ("integer", "inf", "expected a whole number, got 'inf'"),
        ("integer", "٣", "expected a whole number"),
        ("integer", 2**63, "is too large for a 64-bit integer"),
        ("bool", 1, "expected true or false, got 1"),
        ("bool", "maybe", "expected true or false"),
        ("bool", "1", "expected true or false, got '1'"),
        ("string", 5, "expected a string, got 5: put it in quotes"),
        ("string", None, "expected a string, got nothing"),
        ("string", "a\0b", "NUL"),
        ("string", "\ud800", "not valid Unicode"),
        ("string_array", "abc", "expected a list, such as [1, 2], got 'abc'"),
        ("double_array", "[1, x]", "expected a number, got 'x'"),
        ("double_array", "[1, ", "a value is missing here"),
        ("byte_array", [256], "expected bytes, 0 to 255"),
        ("not_set", [], "has no type"),
        ("not_set", [1, "a"], "one type"),
        ("not_set", [[1]], "one type"),
        ("not_set", {}, "expected a list"),
    ],
)
def test_what_does_not_fit_is_refused_in_words(kind: str, value: Any, words: str) -> None:
    with pytest.raises(WrongValueError) as caught:
        carried(kind, value)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (True, "bool"),
        (1, "integer"),
        (1.0, "double"),
        ("1", "string"),
        (b"", "byte_array"),
        ([1, 2], "integer_array"),
        ([1, 2.0], "double_array"),
        ([True], "bool_array"),
        (["a"], "string_array"),
    ],
)
def test_a_parameter_without_a_type_takes_that_of_the_value(value: Any, kind: str) -> None:
    tree = carried("not_set", value)
    assert TYPES[int(str(tree["type"]))] == kind
    assert plain(tree) == value
