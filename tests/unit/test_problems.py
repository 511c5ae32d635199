"""The messages of refused commands: the same ones in both languages."""

from __future__ import annotations

import re

import pytest

from robot.commands.problems import TEMPLATES, TEMPLATES_RU, CommandError, Problem, field_name
from robot.commands.schema import parse_llm


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
    assert problem.in_russian() == "должно быть от -0.5 до 0.5 м/с, а не 7"


def test_units_of_all_fields_are_russian_in_russian() -> None:
    """A range is that of a field, and English letters tell nothing to who reads Russian alone."""
    text = """{"thought": "", "commands": [
        {"action": "drive", "speed": 9, "steering": 9},
        {"action": "turn_head", "pan": 999, "tilt": 999}]}"""
    with pytest.raises(CommandError) as refused:
        parse_llm(text)
    units = {problem.in_russian().split(", ")[0].split()[-1] for problem in refused.value.problems}
    assert units == {"м/с", "рад", "°"}


def test_a_decimal_comma_is_told_with_its_mend() -> None:
    problem = Problem.of("decimal_comma", mended="0.5")
    assert problem.message == "write a fraction with a point: 0.5"
    assert problem.in_russian() == "дробь — через точку: 0.5"


def test_a_field_is_named_as_in_a_program() -> None:
    assert field_name(("commands", 1, "speed")) == "commands[1].speed"
    assert field_name((0, "a")) == "[0].a"
    assert field_name(()) == ""
