"""A type that is missing: what to install, by each of the three roads that has it."""

from __future__ import annotations

from pathlib import Path

import pytest

from graph.messages.packages import ON_PYPI, how_to_install, install_names
from graph.messages.stand_in import stand_in
from graph.messages.types import UnknownTypeError, load_message
from graph.observer.troubles import structural
from graph.scan.endpoints import TopicEnds

ROOT = Path(__file__).parents[3]
NOBODY = TopicEnds("/t", ())


def test_packages_on_pypi_have_three_names_and_others_two() -> None:
    name = "ros-jazzy-nav-msgs"
    assert install_names("nav_msgs") == {"pip": name, "apt": name, "pixi": name}
    assert install_names("foo_bar_msgs") == {
        "apt": "ros-jazzy-foo-bar-msgs",
        "pixi": "ros-jazzy-foo-bar-msgs",
    }


def test_every_package_of_messages_that_deck_takes_from_pypi_is_known() -> None:
    text = (ROOT / "pyproject.toml").read_text()
    taken = {
        line.split(">=")[0].strip(' "').removeprefix("ros-jazzy-").replace("-", "_")
        for line in text.splitlines()
        if line.strip().startswith('"ros-jazzy-') and "-msgs" in line
    }
    assert taken
    assert taken <= ON_PYPI


def test_words_name_what_to_type() -> None:
    assert how_to_install("foo_msgs") == (
        "package foo_msgs is not installed: 'apt install ros-jazzy-foo-msgs' or "
        "'pixi add ros-jazzy-foo-msgs', or build it and source its workspace"
    )
    assert "'pip install ros-jazzy-std-srvs'" in how_to_install("std_srvs")
    assert "interfaces/" in how_to_install("deck_interfaces")
    assert install_names("deck_interfaces") == {}


def test_a_missing_package_is_told_with_its_names_and_a_missing_type_without() -> None:
    with pytest.raises(UnknownTypeError, match="'apt install ros-jazzy-foo-msgs'") as found:
        load_message("foo_msgs/msg/Bar")
    facts = structural(NOBODY, "foo_msgs/msg/Bar", found.value).facts
    assert facts["apt"] == facts["pixi"] == "ros-jazzy-foo-msgs"
    assert "pip" not in facts
    with pytest.raises(UnknownTypeError, match="without msg/Flot32; did you mean") as found:
        load_message("std_msgs/msg/Flot32")
    assert "apt" not in structural(NOBODY, "std_msgs/msg/Flot32", found.value).facts


def test_a_stand_in_is_made_once_and_only_of_names() -> None:
    made = stand_in("foo_msgs/msg/Bar")
    assert made is not None
    assert made is stand_in("foo_msgs/msg/Bar")
    assert stand_in("foo_msgs/Bar") is None
    assert stand_in("foo msgs/msg/B r") is None


def test_no_stand_in_where_the_middleware_is_another(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("graph.messages.stand_in.MIDDLEWARE", "rmw_other_cpp")
    assert stand_in("foo_msgs/msg/Another") is None
    monkeypatch.undo()
    monkeypatch.setattr("graph.messages.stand_in.MODEL", ({b"std_msgs::msg"}, b"Text"))
    assert stand_in("foo_msgs/msg/AThird") is None
