"""The messages of refused commands: the same ones in both languages."""

from __future__ import annotations

import pytest

from robot.commands.problems import CommandError, Problem, field_name
from robot.commands.schema import parse_llm


def test_a_problem_speaks_russian() -> None:
    problem = Problem.of("range", low=-0.5, high=0.5, unit="m/s", value=7.0)
    assert problem.message == "must be from -0.5 to 0.5 m/s, not 7"
    assert problem.in_language("ru") == "должно быть от -0.5 до 0.5 м/с, а не 7"


def test_units_of_all_fields_are_russian_in_russian() -> None:
    """A range is that of a field, and English letters tell nothing to who reads Russian alone."""
    text = """{"thought": "", "commands": [
        {"action": "drive", "speed": 9, "steering": 9},
        {"action": "turn_head", "pan": 999, "tilt": 999}]}"""
    with pytest.raises(CommandError) as refused:
        parse_llm(text)
    told = [problem.in_language("ru") for problem in refused.value.problems]
    units = {words.split(", ")[0].split()[-1] for words in told}
    assert units == {"м/с", "рад", "°"}


def test_a_decimal_comma_is_told_with_its_mend() -> None:
    problem = Problem.of("decimal_comma", mended="0.5")
    assert problem.message == "write a fraction with a point: 0.5"
    assert problem.in_language("ru") == "дробь — через точку: 0.5"


def test_a_field_is_named_as_in_a_program() -> None:
    assert field_name(("commands", 1, "speed")) == "commands[1].speed"
    assert field_name((0, "a")) == "[0].a"
    assert field_name(()) == ""
