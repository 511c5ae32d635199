"""Quick announcements are for one machine, and never against what a user has chosen."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from launcher.discovery import VARIABLES, hurry_discovery, quick_discovery


def test_on_one_machine_both_names_lead_to_the_file() -> None:
    chosen = quick_discovery({}, "localhost")
    assert set(chosen) == set(VARIABLES)
    (path,) = set(chosen.values())
    assert path is not None
    period = ET.parse(Path(path)).getroot().findtext(".//{*}leaseAnnouncement/{*}nanosec")
    assert period == "200000000"


@pytest.mark.parametrize("discovery", ["subnet", ("192.168.1.5",)])
def test_a_network_is_not_flooded(discovery: str | tuple[str, ...]) -> None:
    environ = {"HOME": "/home/me"}
    hurry_discovery(environ, "localhost")
    assert set(environ) == {"HOME", *VARIABLES}
    hurry_discovery(environ, discovery)
    assert environ == {"HOME": "/home/me"}


@pytest.mark.parametrize("name", VARIABLES)
def test_a_users_own_profiles_stay(name: str) -> None:
    assert quick_discovery({name: "/mine.xml"}, "localhost") == {}
