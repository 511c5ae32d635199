"""What comes from below the screens in English is shown in the language of the screen."""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from graph.data import ParameterRow
from graph.messages.types import UnknownTypeError, load_message
from graph.observer.requests import ObserverError
from graph.replay.replay import refused
from tests.tui.recorded import topic
from text.i18n import localized, set_language
from tui.graph.parameter_dialog import ParameterDialog
from tui.graph.parameter_words import allowed_words
from tui.topics.table.columns import state_text
from tui.yaml_form.words import reason_words

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(autouse=True)
def russian() -> Iterator[None]:
    set_language("ru")
    yield
    set_language("en")


def latin(words: str) -> bool:
    """Whether there is no word of Russian in it."""
    return not any("а" <= char <= "я" for char in words.lower())


def test_what_a_recording_refuses() -> None:
    future: Future[int] = refused()
    error = future.exception(1)
    assert isinstance(error, ObserverError)
    assert reason_words(error) == "это запись: принять сообщение некому"


@pytest.mark.parametrize(
    "name", ["std_msgs", "std_msgs/msg/Strin", "no_such_msgs/msg/Any", "std_msgs/srv/Any"]
)
def test_a_type_that_is_not_there(name: str) -> None:
    with pytest.raises(UnknownTypeError) as found:
        load_message(name)
    assert not latin(localized(found.value.reason))
    assert not latin(reason_words(found.value))


def test_peers_that_disagree_about_a_type() -> None:
    facts = {"types": "a/msg/A, b/msg/B", "shown": "a/msg/A"}
    row = replace(topic("/x", "a/msg/A", 1.0), detail="peers disagree", facts=facts)
    assert state_text(row) == "! типы разные"


def test_what_a_parameter_is_for() -> None:
    row = ParameterRow("critical_distance", "double", 0.5, "Nearer than this is danger")
    dialog = ParameterDialog("/safety_node", row, lambda _value: None)  # type: ignore[arg-type, return-value]
    assert "Ближе этого — опасность" in dialog.words().plain
    foreign = ParameterDialog("/x", replace(row, description="gain"), dialog._apply)
    assert "gain" in foreign.words().plain


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (ParameterRow("a", "double", 1.0, "", "0.1 .. 60 s", False, 0.1, 60.0), "0.1…60 с"),
        (ParameterRow("a", "double", 1.0, "", "0 .. 1", False, 0.0, 1.0), "0…1"),
        (
            ParameterRow("a", "integer", 1, "", "0 .. 9 rad/s", True, 0, 9),
            "только чтение, 0…9 рад/с",
        ),
        (ParameterRow("a", "integer", 1, "", "0 .. 2147483648", False, 0, 2**31), "0…2147483648"),
        (ParameterRow("a", "double", 1.0, "", "0 .. 1 furlong", False, 0.0, 1.0), "0…1 furlong"),
        (ParameterRow("a", "double", 1.0, "", "0 .. 2 s", False, 0.0, 1.0), "0…1, 0 .. 2 s"),
        (ParameterRow("a", "double", 1.0, "", "a .. b s", False, 0.0, 1.0), "0…1, a .. b s"),
        (ParameterRow("a", "string", "", "", "text, may be empty"), "строка, может быть пустой"),
        (ParameterRow("a", "string", "", "", "as you like"), "as you like"),
    ],
)
def test_what_a_parameter_may_be(row: ParameterRow, words: str) -> None:
    assert allowed_words(row) == words
