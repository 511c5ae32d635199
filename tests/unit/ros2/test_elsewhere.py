"""What the real tool has and this one has not ends with 2, and says where Deck does the same."""

from __future__ import annotations

import pytest

from ros2 import elsewhere
from ros2.main import COMMANDS, main
from ros2.verb import VERBS

ELSEWHERE: dict[tuple[str, ...], str] = {
    **{tuple(words): told for words, told in elsewhere.VERBS.items()},
    **{(name,): told for name, told in elsewhere.COMMANDS.items()},
}


@pytest.mark.parametrize(("words", "told"), ELSEWHERE.items())
def test_where_it_is_instead_is_told(words: tuple[str, ...], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    assert capsys.readouterr().err.endswith(f"'{words[-1]}' is not in Deck's ros2. {told}\n")


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_and_each_of_its_verbs_have_help(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    if command != "run":
        assert main([command]) == 0
    mine = [name for name in VERBS if name.split()[0] == command] or [command]
    for name in mine:
        with pytest.raises(SystemExit) as ended:
            main([*name.split(), "--help"])
        assert ended.value.code == 0
        assert f"usage: ros2 {name} " in capsys.readouterr().out
