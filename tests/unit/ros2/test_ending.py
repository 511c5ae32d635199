"""Ctrl-C in the middle of anything is Ctrl-C."""

from __future__ import annotations

from ros2.ending import was_interrupted


def test_an_interrupted_conversion_is_an_interruption_and_a_failed_one_is_not() -> None:
    failed = TypeError("Unable to convert function return value to a Python type!")
    assert not was_interrupted(failed)
    failed.__cause__ = ImportError("of a type")
    assert not was_interrupted(failed)
    failed.__cause__.__context__ = KeyboardInterrupt()
    assert was_interrupted(failed)
