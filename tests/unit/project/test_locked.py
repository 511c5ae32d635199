"""What is locked is what pyproject.toml asks for, to the file, for every Python."""

from __future__ import annotations

import re
from typing import cast

import pytest
from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.unit.scripts_of_setup import ROOT, load

lock = load("lock")
PYTHONS = ["3.10", "3.11", "3.12", "3.13"]
NAMES = ["deck", "interfaces", "view"]


def machine(python: str) -> dict[str, str]:
    """Return what markers are judged by, on a Linux of today with this Python."""
    return {
        **cast("dict[str, str]", default_environment()),
        "python_version": python,
        "python_full_version": f"{python}.4",
        "sys_platform": "linux",
        "platform_machine": "x86_64",
    }


def entries(name: str) -> list[tuple[Requirement, list[str]]]:
    """Return each pinned requirement of a file, with its hashes."""
    text = (ROOT / "locked" / f"{name}.txt").read_text().replace("\\\n", " ")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return [
        (Requirement(line.partition(" --hash")[0].strip()), re.findall(r"--hash=(\S+)", line))
        for line in lines
    ]


@pytest.mark.parametrize("name", NAMES)
def test_every_line_is_one_version_with_its_hashes_and_no_address(name: str) -> None:
    for requirement, hashes in entries(name):
        assert re.fullmatch(r"==[^,*]+", str(requirement.specifier)), requirement
        assert requirement.url is None
        assert hashes, requirement
        assert all(re.fullmatch(r"sha256:[0-9a-f]{64}", one) for one in hashes)
    assert "://" not in (ROOT / "locked" / f"{name}.txt").read_text()


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("name", NAMES)
def test_what_is_asked_for_is_locked_once_for_every_python(name: str, python: str) -> None:
    here = machine(python)
    locked: dict[str, list[Requirement]] = {}
    # What both need is in the one that is installed first.
    files = ["deck", "view"] if name == "view" else [name]
    for requirement, _hashes in (entry for file in files for entry in entries(file)):
        if requirement.marker is None or requirement.marker.evaluate(here):
            locked.setdefault(canonicalize_name(requirement.name), []).append(requirement)
    assert all(len(versions) == 1 for versions in locked.values())
    for line in asked_for()[name]:
        wanted = Requirement(line)
        if wanted.marker is not None and not wanted.marker.evaluate(here):
            continue
        (found,) = locked[canonicalize_name(wanted.name)]
        (version,) = found.specifier
        assert wanted.specifier.contains(version.version, prereleases=True), line


def asked_for() -> dict[str, list[str]]:
    """Return what both pyproject.toml ask for."""
    asked: dict[str, list[str]] = lock.requirements()
    return asked
