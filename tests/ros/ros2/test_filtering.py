"""What is wrong with an expression of `--filter` is said, with the exit code 2."""

from __future__ import annotations

import sys

import pytest

from tests.ros.ros2.typed import typed


@pytest.mark.parametrize(
    ("expression", "why"),
    [
        ("m.data >", "column 9: invalid syntax"),
        ("m.data > 1 and", "column 15: invalid syntax"),
        pytest.param(f"0{'-' * 10_000}1", "is nested too deeply", id="deep"),
        ("m.data = 1", "column 8: invalid syntax"),
        ("m.data == «x»", "column 11: invalid character '«' (U+00AB)"),
        ("m.dta > 0", "dta: no such field; did you mean data?"),
        ("m.header.frame_id", "header: no such field; there is data"),
        ("data > 0", "data is unknown: the message is called m"),
        ("m.data.x", "AttributeError: 'float' object has no attribute 'x'"),
        ("1 / (m.data - 0.25)", "ZeroDivisionError: float division by zero"),
    ],
)
def test_a_wrong_filter_is_told(expression: str, why: str) -> None:
    echo = typed("topic", "echo", "/distance", "--once", "--filter", expression)
    assert (echo.code, echo.out) == (2, "")
    assert f"filter expression '{expression[:40]}" in echo.err
    if sys.version_info < (3, 11) and "invalid syntax" in echo.err:
        return  # It has other words, and other places, for what it cannot read.
    assert why in echo.err, echo.err


def test_what_is_wanted_is_shown() -> None:
    echo = typed("topic", "echo", "/distance", "--once", "--filter", " abs(m.data) < 1")
    assert (echo.code, echo.out) == (0, "data: 0.25\n---\n")
