"""Writing little profiles for tests, and reading what is wrong with them."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

from launcher.errors import ProfileError, ProfileProblem
from launcher.profile.load import Profile, load_profile


def written(folder: Path, text: str, name: str = "lesson.yaml") -> Path:
    path = folder / name
    path.write_text(dedent(text), encoding="utf-8")
    return path


def loaded(folder: Path, text: str, **options: Any) -> Profile:
    return load_profile(written(folder, text), environ={}, **options)


def problems(folder: Path, text: str, **options: Any) -> tuple[ProfileProblem, ...]:
    try:
        loaded(folder, text, **options)
    except ProfileError as error:
        return error.problems
    return ()


def told(folder: Path, text: str, **options: Any) -> list[str]:
    path = f"{folder / 'lesson.yaml'}:"
    return [str(problem).removeprefix(path) for problem in problems(folder, text, **options)]


def refused(path: Path) -> str:
    """Why this file is no profile."""
    with pytest.raises(ProfileError) as caught:
        load_profile(path)
    return str(caught.value)
