"""Profiles are found by path, by name, by lesson, by a beginning; the rest gets a suggestion."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.errors import ProfileNotFoundError, UsageError
from launcher.profile.catalog import find_profile, list_profiles
from tests.unit.profile_files import written


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    ("asked", "found"),
    [
        ("09-brain", "09-brain"),
        ("9", "09-brain"),
        ("09", "09-brain"),
        ("1", "01-hello"),
        ("10", "10-llm-json"),
        ("4", "04-ackermann"),
        ("4b", "04b-electronic-differential"),
        ("06-r", "06-rviz"),
    ],
)
def test_a_lesson_is_found_by_what_people_type(asked: str, found: str) -> None:
    assert find_profile(asked).stem == found


def test_a_path_is_taken_as_it_is(tmp_path: Path) -> None:
    own = written(tmp_path, "nodes: {}", "robot.yaml")
    assert find_profile(str(own)) == own
    assert find_profile("robot.yaml") == Path("robot.yaml")
    assert find_profile("./none") == Path("./none")


def test_own_profiles_go_before_the_course(tmp_path: Path) -> None:
    (tmp_path / "profiles").mkdir()
    written(tmp_path / "profiles", "nodes: {}", "09-brain.yaml")
    assert find_profile("09-brain") == Path("profiles/09-brain.yaml")


@pytest.mark.parametrize(
    ("asked", "near"),
    [("brain", "09-brain"), ("09-brian", "09-brain"), ("sonar", "02-sonar-safety")],
)
def test_a_wrong_name_gets_a_suggestion(asked: str, near: str) -> None:
    with pytest.raises(ProfileNotFoundError) as caught:
        find_profile(asked)
    assert near in caught.value.near
    assert near in str(caught.value)


def test_a_name_near_nothing_points_at_the_list() -> None:
    with pytest.raises(ProfileNotFoundError, match="`deck list` shows them all"):
        find_profile("zzzz")


def test_a_beginning_that_fits_several_is_told() -> None:
    with pytest.raises(UsageError, match="'0' matches several: 01-hello, 02-sonar-safety"):
        find_profile("0")


def test_a_broken_profile_is_listed_with_its_error(tmp_path: Path) -> None:
    (tmp_path / "profiles").mkdir()
    written(tmp_path / "profiles", "nodes: {a: {}}", "broken.yaml")
    broken = next(entry for entry in list_profiles() if entry.name == "broken")
    assert broken.error.startswith("profiles/broken.yaml:1:9: nodes.a: needs `run` or `exec`")


def test_further_files_and_folders_are_listed(tmp_path: Path) -> None:
    (tmp_path / "more").mkdir()
    written(tmp_path / "more", "title: {en: More}\nnodes: {a: {exec: [x]}}", "more.yaml")
    one = written(tmp_path, "nodes: {b: {exec: [x]}}", "one.yml")
    entries = {entry.name: entry for entry in list_profiles([tmp_path / "more", one])}
    assert entries["more"].title == {"en": "More"}
    assert entries["one"].nodes == ("b",)


def test_a_link_to_itself_is_listed_with_what_is_wrong(tmp_path: Path) -> None:
    (tmp_path / "profiles").mkdir()
    link = tmp_path / "profiles" / "loop.yaml"
    link.symlink_to(link)
    (entry,) = (entry for entry in list_profiles() if entry.name == "loop")
    assert "cannot be read: Too many levels of symbolic links" in entry.error
