"""A key works by its place, whatever is printed on it."""

import pytest

from tui.actions.layouts import LATIN_OF, on_all_layouts


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ("x,ч", "x,ч,χ,ס"),
        ("s", "s,ы,і,σ,ד"),
        ("N", "N,Т,Ν"),
        ("alt+v", "alt+v,alt+м,alt+ω,alt+ה"),
        ("f12,slash,ctrl+space,left", "f12,slash,ctrl+space,left"),
    ],
)
def test_the_keys_of_other_layouts_are_those_in_its_place(keys: str, expected: str) -> None:
    assert on_all_layouts(keys) == expected


def test_each_letter_of_the_latin_keyboard_is_on_the_cyrillic_one() -> None:
    cyrillic = {latin for letter, latin in LATIN_OF.items() if "а" <= letter <= "я"}
    assert set("abcdefghijklmnopqrstuvwxyz") <= cyrillic
