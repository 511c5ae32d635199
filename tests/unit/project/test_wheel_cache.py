"""Wheels that a second clone takes from the first."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.unit.scripts_of_setup import load

wheel_cache = load("wheel_cache")
WHEEL = "deck_robot_interfaces-0.1.0-cp311-cp311-linux_x86_64.whl"


@pytest.fixture(autouse=True)
def _kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One wheel, kept for the key `sources`."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "built").mkdir()
    (tmp_path / "built" / WHEEL).write_bytes(b"compiled")
    wheel_cache.WheelCache("sources").keep(tmp_path / "built")


def fetched(tmp_path: Path, *ingredients: str) -> list[tuple[str, bytes]]:
    wheels = tmp_path / "wheels"
    found = wheel_cache.WheelCache(*ingredients).fetch(wheels)
    assert found == wheels.exists()
    return [(path.name, path.read_bytes()) for path in wheels.iterdir()] if found else []


def test_a_second_clone_gets_the_wheels_of_the_first(tmp_path: Path) -> None:
    assert fetched(tmp_path, "sources") == [(WHEEL, b"compiled")]


def test_other_sources_are_built(tmp_path: Path) -> None:
    assert fetched(tmp_path, "other sources") == []


def test_another_python_has_wheels_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(wheel_cache.platform, "python_version", lambda: "3.99.0")
    assert fetched(tmp_path, "sources") == []


@pytest.mark.parametrize("damage", [b"comp", b"", None])
def test_what_is_damaged_is_built_again_and_replaced(tmp_path: Path, damage: bytes | None) -> None:
    cache = wheel_cache.WheelCache("sources")
    if damage is None:
        (cache.folder / WHEEL).unlink()
    else:
        (cache.folder / WHEEL).write_bytes(damage)
    assert fetched(tmp_path, "sources") == []
    cache.keep(tmp_path / "built")
    assert fetched(tmp_path, "sources") == [(WHEEL, b"compiled")]
    assert [path.name for path in cache.folder.parent.iterdir()] == [cache.folder.name]


def test_what_another_user_can_write_is_not_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = wheel_cache.WheelCache("sources")
    cache.folder.chmod(0o777)
    assert fetched(tmp_path, "sources") == []
    cache.folder.chmod(0o700)
    us = os.geteuid()
    monkeypatch.setattr(wheel_cache.os, "geteuid", lambda: us + 1)
    assert fetched(tmp_path, "sources") == []


def test_a_link_is_not_followed(tmp_path: Path) -> None:
    cache = wheel_cache.WheelCache("sources")
    elsewhere = cache.folder.rename(tmp_path / "elsewhere")
    cache.folder.symlink_to(elsewhere)
    assert fetched(tmp_path, "sources") == []


def test_where_nothing_can_be_kept_nothing_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "/dev/null/cache")
    wheel_cache.WheelCache("sources").keep(tmp_path / "built")
    assert fetched(tmp_path, "sources") == []
