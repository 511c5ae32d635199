"""How often Deck's own node announces itself: often on one machine, as usual on a network."""

from __future__ import annotations

import os

import pytest

from graph.ros import FAST_DDS, FAST_DDS_VARIABLES, ONLY_THESE, announcing
from launcher.domain.discovery import settings_of_discovery


@pytest.fixture(autouse=True)
def _nothing_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in FAST_DDS_VARIABLES:
        monkeypatch.delenv(name, raising=False)


def test_on_one_machine_it_is_hurried() -> None:
    ours = dict.fromkeys(FAST_DDS_VARIABLES, str(FAST_DDS))
    assert announcing("localhost") == {**ours, ONLY_THESE: "1"}


@pytest.mark.parametrize("discovery", ["subnet", ("192.0.2.7",)])
def test_on_a_network_it_is_not_even_under_a_program_that_is(
    discovery: str | tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(FAST_DDS_VARIABLES[0], str(FAST_DDS))
    assert announcing(discovery) == dict.fromkeys((*FAST_DDS_VARIABLES, ONLY_THESE))


def test_what_the_user_has_chosen_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FAST_DDS_VARIABLES[1], "/etc/fastdds.xml")
    assert announcing("localhost") == announcing("subnet") == {}


@pytest.mark.parametrize("discovery", ["localhost", "subnet", ("192.168.1.7",)])
@pytest.mark.parametrize("chosen", ["", "/mine.xml"])
def test_the_screen_is_found_like_the_nodes_of_a_session(
    discovery: str | tuple[str, ...], chosen: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(FAST_DDS_VARIABLES[0], chosen)
    assert announcing(discovery) == settings_of_discovery(os.environ, discovery)
