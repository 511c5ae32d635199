"""Quick announcements are for one machine, and never against what a user has chosen."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from launcher.domain.discovery import (
    ONLY_THESE,
    VARIABLES,
    set_discovery,
    settings_of_discovery,
    why_open,
)


def test_on_one_machine_both_names_lead_to_the_file() -> None:
    chosen = settings_of_discovery({}, "localhost")
    assert set(chosen) == {*VARIABLES, ONLY_THESE}
    (path,) = {chosen[name] for name in VARIABLES}
    assert path is not None
    period = ET.parse(Path(path)).getroot().findtext(".//{*}leaseAnnouncement/{*}nanosec")
    assert period == "200000000"


@pytest.mark.parametrize("discovery", ["subnet", ("192.168.1.5",)])
def test_a_network_is_not_flooded(discovery: str | tuple[str, ...]) -> None:
    environ = {"HOME": "/home/me"}
    set_discovery(environ, "localhost")
    assert set(environ) == {"HOME", *VARIABLES, ONLY_THESE}
    set_discovery(environ, discovery)
    assert environ == {"HOME": "/home/me"}


@pytest.mark.parametrize("name", VARIABLES)
def test_a_users_own_profiles_stay(name: str) -> None:
    assert settings_of_discovery({name: "/mine.xml"}, "localhost") == {}
    words = why_open({name: "/mine.xml"}, "localhost")
    assert words is not None
    assert words.startswith(f"{name} is set")
    assert why_open({name: "/mine.xml"}, "subnet") is None


def test_another_middleware_is_told_and_decks_own_settings_are_not() -> None:
    ours = {name: value or "" for name, value in settings_of_discovery({}, "localhost").items()}
    assert why_open(ours, "localhost") is None
    assert why_open({**ours, "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}, "localhost") is None
    words = why_open({**ours, "RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}, "localhost")
    assert words is not None
    assert "rmw_cyclonedds_cpp" in words
