"""What `make` says on a machine that cannot run Deck, and which Python it takes on one that can."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.unit.scripts_of_setup import SCRIPTS, load

preflight = load("preflight")

Facts = dict[str, Any]


def program(path: Path, text: str = "exit 0") -> Path:
    """Write a shell script that anyone may run."""
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


@pytest.fixture
def facts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Facts:
    """A machine that has all it takes."""
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.delenv("CXX", raising=False)
    program(tmp_path / "cc")
    program(tmp_path / "c++")
    (tmp_path / "Python.h").touch()
    return {
        "system": "Linux",
        "arch": "x86_64",
        "bits": 64,
        "libc": ("glibc", "2.28"),
        "python": (3, 12),
        "path": str(tmp_path),
        "modules": ["venv", "ensurepip"],
        "include": str(tmp_path),
    }


def complaints(facts: Facts) -> list[str]:
    """Return all that preflight has to say about a machine."""
    return list(preflight.complaints(preflight.Machine(**facts)))


def test_a_machine_that_has_all_it_takes_is_left_alone(facts: Facts) -> None:
    assert complaints(facts) == []


@pytest.mark.parametrize("version", [(3, 10), (3, 11), (3, 12), (3, 13)])
def test_every_python_of_the_promise_will_do(facts: Facts, version: tuple[int, int]) -> None:
    assert complaints(facts | {"python": version}) == []


@pytest.mark.parametrize(
    ("lack", "words"),
    [
        ({"arch": "aarch64"}, ["aarch64", "pixi run deck"]),
        ({"system": "Darwin"}, ["Darwin", "pixi run deck"]),
        ({"bits": 32}, ["32-bit", "pixi run deck"]),
        ({"libc": ("", "")}, ["glibc", "pixi run deck"]),
        ({"libc": ("glibc", "2.27")}, ["glibc 2.28", "pixi run deck"]),
        ({"python": (3, 9)}, ["Python 3.9", "3.10 to 3.13"]),
        ({"python": (3, 14)}, ["Python 3.14", "3.10 to 3.13"]),
        ({"modules": ["venv"]}, ["apt install python3.12-venv"]),
        ({"modules": []}, ["apt install python3.12-venv"]),
        ({"include": "/nowhere"}, ["apt install python3.12-dev"]),
    ],
    ids=lambda value: str(value) if isinstance(value, dict) else "",
)
def test_what_is_lacking_is_said_in_one_line_with_its_cure(
    facts: Facts, lack: Facts, words: list[str]
) -> None:
    (said,) = complaints(facts | lack)
    assert "\n" not in said
    assert all(word in said for word in words)


@pytest.mark.parametrize(("name", "word"), [("cc", "C compiler"), ("c++", "C++ compiler")])
def test_a_missing_compiler_is_named(facts: Facts, tmp_path: Path, name: str, word: str) -> None:
    (tmp_path / name).unlink()
    (said,) = complaints(facts)
    assert f"no {word}: sudo apt install build-essential" in said


def test_a_compiler_of_ones_own_will_do(
    facts: Facts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "cc").rename(tmp_path / "my-cc")
    monkeypatch.setenv("CC", "my-cc -m64")
    assert complaints(facts) == []


@pytest.fixture
def find_python(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """`find-python.sh` on a search path that holds no Python but those of `tmp_path`."""
    (tmp_path / "dirname").symlink_to("/usr/bin/dirname")

    def run(**environ: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["/bin/sh", SCRIPTS / "find-python.sh"],
            env={"PATH": str(tmp_path), **environ},
            capture_output=True,
            text=True,
            check=False,
        )

    return run


def stand_in(path: Path, preflight_says: str = "") -> None:
    """Write a Python that answers where it is, and what preflight would say on it."""
    verdict = f"echo {preflight_says} >&2; exit 1" if preflight_says else "exit 0"
    program(path, f'case "$1" in -c) echo {path};; *) {verdict};; esac')


Find = Callable[..., subprocess.CompletedProcess[str]]


def test_the_newest_python_is_taken(find_python: Find, tmp_path: Path) -> None:
    stand_in(tmp_path / "python3")
    stand_in(tmp_path / "python3.11")
    stand_in(tmp_path / "python3.12")
    assert find_python().stdout == f"{tmp_path / 'python3.12'}\n"


def test_a_newer_python_that_lacks_something_gives_way(find_python: Find, tmp_path: Path) -> None:
    stand_in(tmp_path / "python3.13", "lacks venv")
    stand_in(tmp_path / "python3.11")
    assert find_python().stdout == f"{tmp_path / 'python3.11'}\n"


def test_a_stub_with_no_python_behind_it_gives_way(find_python: Find, tmp_path: Path) -> None:
    program(tmp_path / "python3.13", "echo no such version; exit 127")
    stand_in(tmp_path / "python3")
    assert find_python().stdout == f"{tmp_path / 'python3'}\n"


def test_the_python_asked_for_is_the_only_one(find_python: Find, tmp_path: Path) -> None:
    stand_in(tmp_path / "python3.12")
    stand_in(tmp_path / "mine", "lacks headers")
    found = find_python(PYTHON="mine")
    assert (found.returncode, found.stdout, found.stderr) == (1, "", "lacks headers\n")


def test_without_any_python_it_says_what_to_install(find_python: Find) -> None:
    found = find_python()
    assert found.returncode == 1
    assert "install Python 3.10 to 3.13" in found.stderr
    assert found.stderr.count("\n") == 1


def test_a_real_python_without_a_compiler_says_so(find_python: Find) -> None:
    found = find_python(PYTHON=sys.executable)
    assert found.returncode == 1
    assert found.stderr.startswith("deck: ")
    assert found.stderr.count("\n") == 1


def test_an_activated_environment_leads_to_the_python_below_it(tmp_path: Path) -> None:
    """The environment may be the one that is about to be replaced."""
    mine = tmp_path / "activated"
    venv.create(mine, symlinks=True)
    script = shutil.copy(SCRIPTS / "find-python.sh", tmp_path)
    (tmp_path / "preflight.py").touch()  # whatever this machine lacks
    environ = {**os.environ, "PYTHON": str(mine / "bin" / "python")}
    found = subprocess.check_output(["/bin/sh", script], env=environ, text=True)
    taken = Path(found.strip())
    assert taken.parent != mine / "bin"
    assert taken.samefile(mine / "bin" / "python")
