"""The messages of refused commands: the same ones in both languages."""

from __future__ import annotations

import re

import pytest

from robot.problems import TEMPLATES, TEMPLATES_RU, Problem, field_name


def fields(template: str) -> list[str]:
    return sorted(re.findall(r"\{(\w+)", template))


def test_both_languages_have_the_same_messages() -> None:
    assert TEMPLATES.keys() == TEMPLATES_RU.keys()


@pytest.mark.parametrize("code", TEMPLATES)
def test_both_languages_say_the_same_things(code: str) -> None:
    assert fields(TEMPLATES[code]) == fields(TEMPLATES_RU[code])


def test_a_problem_speaks_russian() -> None:
    problem = Problem.of("range", low=-0.5, high=0.5, unit="m/s", value=7.0)
    assert problem.message == "must be from -0.5 to 0.5 m/s, not 7"
    assert problem.in_russian() == "должно быть от -0.5 до 0.5 m/s, а не 7"


def test_a_decimal_comma_is_told_with_its_mend() -> None:
    problem = Problem.of("decimal_comma", mended="0.5")
    assert problem.message == "write a fraction with a point: 0.5"
    assert problem.in_russian() == "дробь — через точку: 0.5"


def test_a_field_is_named_as_in_a_program() -> None:
    assert field_name(("commands", 1, "speed")) == "commands[1].speed"
    assert field_name((0, "a")) == "[0].a"
    assert field_name(()) == ""
