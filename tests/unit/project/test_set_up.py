"""The set-up: what a machine lacks, which Python is taken, what is whole, and what make runs."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.unit.scripts_of_setup import ROOT, SCRIPTS, load
from text.i18n import detect

preflight, environment, wheel_cache, words = map(load, ("preflight", "environment", "wheel_cache", "setup_words"))
PI = "pixi run deck"


def program(path: Path, text: str = "exit 0") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


# ---------------------------------------------------------------- the machine


@pytest.mark.parametrize(
    ("lack", "told"),
    [
        ({}, []),
        ({"python": (3, 10)}, []),
        ({"python": (3, 13)}, []),
        ({"arch": "aarch64"}, [("aarch64", PI)]),
        ({"system": "Darwin"}, [("Darwin", PI)]),
        ({"bits": 32}, [("32-bit", PI)]),
        ({"libc": ("", "")}, [("glibc", PI)]),
        ({"libc": ("glibc", "2.27")}, [("glibc 2.28", PI)]),
        ({"python": (3, 9)}, [("Python 3.9", "3.10 to 3.13")]),
        ({"python": (3, 14)}, [("Python 3.14", "3.10 to 3.13")]),
        ({"modules": ["venv"]}, [("apt install python3.12-venv",)]),
        ({"include": "/nowhere"}, [("apt install python3.12-dev",)]),
        ({"path": "/nowhere"}, [("no C compiler", "build-essential")]),
    ],
)
def test_what_a_machine_lacks_is_said_in_one_line_with_its_cure(
    lack: dict[str, Any], told: list[tuple[str, ...]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.delenv("CXX", raising=False)
    program(tmp_path / "cc")
    program(tmp_path / "c++")
    (tmp_path / "Python.h").touch()
    whole = {
        "system": "Linux",
        "arch": "x86_64",
        "bits": 64,
        "libc": ("glibc", "2.28"),
        "python": (3, 12),
        "path": str(tmp_path),
        "modules": ["venv", "ensurepip"],
        "include": str(tmp_path),
    }
    said = list(preflight.complaints(preflight.Machine(**whole | lack)))
    assert len(said) >= len(told)
    assert bool(said) == bool(told)
    for line, words in zip(said, told, strict=False):
        assert "\n" not in line
        assert all(word in line for word in words)


@pytest.mark.parametrize(
    ("there", "asked", "taken", "said"),
    [
        ({"python3": "", "python3.11": "", "python3.12": ""}, {}, "python3.12", ""),
        ({"python3.13": "lacks venv", "python3.11": ""}, {}, "python3.11", ""),
        ({"python3.12": "", "mine": "lacks headers"}, {"PYTHON": "mine"}, "", "lacks headers\n"),
        ({}, {}, "", "install Python 3.10 to 3.13"),
    ],
)
def test_which_python_is_taken(
    there: dict[str, str], asked: dict[str, str], taken: str, said: str, tmp_path: Path
) -> None:
    (tmp_path / "dirname").symlink_to("/usr/bin/dirname")
    for name, lack in there.items():
        verdict = f"echo {lack} >&2; exit 1" if lack else "exit 0"
        program(tmp_path / name, f'case "$1" in -c) echo {tmp_path / name};; *) {verdict};; esac')
    found = subprocess.run(
        ["/bin/sh", SCRIPTS / "find-python.sh"],
        env={"PATH": str(tmp_path), **asked},
        capture_output=True,
        text=True,
        check=False,
    )
    assert found.stdout == (f"{tmp_path / taken}\n" if taken else "")
    assert found.returncode == (0 if taken else 1)
    assert said in found.stderr
    assert found.stderr.count("\n") == bool(said)


# ---------------------------------------------------------------- its words


def test_all_that_the_set_up_says_has_its_russian() -> None:
    """`told` takes literals, or a constant of capitals; `Step` and `heading` pass theirs on."""
    said = {"install pixi (https://pixi.sh) and use `pixi run deck`", *re.findall("'(deck: .*)'", makefile())}
    for script in ("preflight.py", "environment.py"):
        for call in ast.walk(ast.parse((SCRIPTS / script).read_text())):
            if isinstance(call, ast.Call) and getattr(call.func, "id", "") in {"told", "Step"}:
                said |= {word.value for word in call.args[:1] if isinstance(word, ast.Constant)}
    assert said <= set(words.RUSSIAN)
    for english, russian in words.RUSSIAN.items():
        assert re.findall("%.", english) == re.findall("%.", russian)


def makefile() -> str:
    return "".join(re.findall("setup_words.py .*\n", (ROOT / "Makefile").read_text()))


@pytest.mark.parametrize(
    "environ",
    [
        {},
        {"LANG": "ru_RU.UTF-8"},
        {"LANG": "ru_RU.UTF-8", "LC_ALL": "C"},
        {"LANG": "C", "LC_MESSAGES": "ru"},
        {"DECK_LANG": "en", "LANG": "ru_RU.UTF-8"},
        {"DECK_LANG": "xx", "LANG": "ru_RU.UTF-8"},
    ],
)
def test_the_set_up_speaks_the_language_that_deck_will_speak(
    environ: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("DECK_LANG", "LC_ALL", "LC_MESSAGES", "LANG"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environ.items():
        monkeypatch.setenv(name, value)
    assert words.speaks_russian() == (detect(environ=environ) == "ru")


def test_a_step_says_how_far_it_has_come(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "deck.txt").write_text("a==1\nb==2 ; python_version < '3'\n")
    (tmp_path / "ros-jazzy.txt").write_text("c==3\n")
    monkeypatch.setattr(environment, "LOCKED", tmp_path)
    log = tmp_path / "log"
    log.write_text("Ignoring b: markers\nCollecting a==1\n")
    assert environment.loaded(log) == "1/2"
    assert environment.built(log) == ""
    log.write_text("  [1/400] Building\n  [100/400] Building [3/5]\n")
    assert environment.built(log) == "25 %"


# ---------------------------------------------------------------- the environment


@pytest.fixture
def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """A tree with a blank in its name, an environment in it, and nothing installed for real."""
    tree = tmp_path / "a tree"
    tree.mkdir()
    (tree / "scripts").symlink_to(ROOT / "scripts")
    subject = environment.Environment(tree / ".venv")
    steps: list[str] = []
    monkeypatch.delenv("PYTHON", raising=False)
    monkeypatch.delenv("ROS", raising=False)

    def step(what: str, *_command: object, **_environ: str) -> SimpleNamespace:
        def finish() -> None:
            steps.append(what)
            (tree / ".venv" / "bin").mkdir()
            subject.python.symlink_to(sys.executable)

        return SimpleNamespace(finish=finish)

    step.ended = step.total = 0  # type: ignore[attr-defined]
    monkeypatch.setattr(environment, "Step", step)
    monkeypatch.setattr(environment.Environment, "install", lambda _self: steps.append("install"))
    return SimpleNamespace(tree=tree, subject=subject, steps=steps)


def is_sound(made: SimpleNamespace, tree: Path | None = None) -> bool:
    """The shell, before each target, and Python read the same marks and must agree."""
    tree = tree or made.tree
    sound: bool = environment.Environment(tree / ".venv").is_sound()
    assert (subprocess.call(["/bin/sh", "scripts/sound.sh"], cwd=tree) == 0) == sound
    return sound


def test_an_environment_is_sound_when_its_set_up_has_ended(
    made: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not is_sound(made)
    made.subject.update()
    assert made.steps == ["Virtual environment", "install"]
    assert is_sound(made)
    made.subject.update()
    assert made.steps == ["Virtual environment", "install", "install"]
    monkeypatch.setenv("ROS", "kilted")
    assert not is_sound(made), "another ROS is asked for"
    made.subject.update()
    monkeypatch.delenv("ROS")
    assert is_sound(made), "and stays"
    monkeypatch.setattr(sys, "executable", "/bin/sh")
    monkeypatch.setenv("PYTHON", "/bin/sh")
    assert not made.subject.is_sound(), "another Python is asked for"


@pytest.mark.parametrize("harm", ["moved", "no Python", "killed"])
def test_an_environment_that_is_not_whole_is_begun_anew(
    made: SimpleNamespace, harm: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def killed(_self: object) -> None:
        raise ChildProcessError("killed by signal 9")

    made.subject.update()
    if harm == "moved":
        assert not is_sound(made, made.tree.rename(made.tree.with_name("elsewhere")))
        return
    if harm == "no Python":
        made.subject.python.unlink()
        made.subject.python.symlink_to("/nowhere/python3")
    else:
        # Half an installation looks whole to pip.
        with monkeypatch.context() as patch:
            patch.setattr(environment.Environment, "install", killed)
            with pytest.raises(ChildProcessError):
                made.subject.update()
    assert not is_sound(made)
    (made.subject.folder / "stale").mkdir()
    made.steps.clear()
    made.subject.update()
    assert made.steps == ["Virtual environment", "install"]
    assert sorted(path.name for path in made.subject.folder.iterdir()) == [".ready", ".ros", "bin"]
    assert is_sound(made)


def test_a_ros_that_is_none_is_refused(
    made: SimpleNamespace, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS", "humble")
    monkeypatch.setattr(environment, "WORK", made.tree / "build")
    assert environment.main(str(made.subject.folder)) == 2
    assert "ROS=humble is neither jazzy nor kilted" in capsys.readouterr().err


def test_an_environment_that_somebody_else_has_made_stays(
    made: SimpleNamespace, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    precious = made.subject.folder / "lib" / "precious.py"
    precious.parent.mkdir(parents=True)
    precious.write_text("mine")
    monkeypatch.setattr(environment, "WORK", made.tree / "build")
    assert environment.main(str(made.subject.folder)) == 1
    said = capsys.readouterr().err.splitlines()[-1]
    assert said.startswith(f"deck: cannot set up here: {made.subject.folder} already exists")
    assert precious.read_text() == "mine"
    assert made.steps == []


def test_what_comes_from_an_index_is_the_very_file_that_was_locked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Everything else is this tree, which needs no index."""
    commands: list[list[str]] = []

    def step(_what: str, *command: str | Path, **_environ: str) -> SimpleNamespace:
        commands.append([str(word) for word in command])
        return SimpleNamespace(finish=lambda: None, abandon=lambda: None)

    def run(command: tuple[str | Path, ...], **_options: object) -> None:
        commands.append([str(word) for word in command])
        if "venv" in command:
            Path(command[-1]).mkdir(parents=True)

    monkeypatch.setenv("ROS", "kilted")
    monkeypatch.setattr(environment, "WORK", tmp_path / "work")
    monkeypatch.setattr(environment.shutil, "rmtree", lambda *_, **__: None)
    monkeypatch.setattr(environment, "Step", step)
    monkeypatch.setattr(environment.subprocess, "run", run)
    (tmp_path / "work" / "wheels").mkdir(parents=True)
    environment.Environment(tmp_path).install_deck()
    environment.build_interfaces(tmp_path / "work" / "wheels", tmp_path / "build")
    installs = [words for words in commands if "install" in words or "wheel" in words]
    assert len(installs) == 4
    for words in installs:
        assert "--require-hashes" in words or {"--no-deps", "--no-build-isolation"} <= {*words}
    locked = [word for words in installs if "--require-hashes" in words for word in words if word.endswith(".txt")]
    assert [Path(word).name for word in locked] == ["deck.txt", "ros-kilted.txt", "interfaces-kilted.txt"]
    built = (tmp_path / "build" / "interfaces" / "pyproject.toml").read_text()
    assert "ros-kilted-rclpy" in built
    assert "jazzy" not in built


# ---------------------------------------------------------------- wheels of an earlier clone


# ---------------------------------------------------------------- the Makefile

DECK = """\
echo "deck $*"
env | grep -E '^(PYTHONPATH|LD_LIBRARY_PATH|_ROS_WHEELS_BOOTSTRAP_COMPLETE)='
exit ${CODE:-0}
"""
PYTHON = """\
case "$1" in
-c) echo "$0" ;;
*preflight.py) exit 0 ;;
*) echo "set-up with $*"; exit 3 ;;
esac
"""
SOURCED = {"AMENT_PREFIX_PATH": "/opt/ros/jazzy", "PYTHONPATH": "/ros", "LD_LIBRARY_PATH": "/ros"}
Make = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A tree that is set up, in a path with a blank in it; its `deck` only tells its words."""
    tree = tmp_path / "a tree"
    for name in ("interfaces", "locked", "nodes/__pycache__", "build/setup", "build/colcon"):
        (tree / name).mkdir(parents=True)
    for name in ("Makefile", "pyproject.toml", "scripts"):
        (tree / name).symlink_to(ROOT / name)
    program(tree / ".venv/bin/deck", DECK)
    python = program(tree / ".venv/bin/python", PYTHON)
    (tree / ".venv/.ready").write_text(f"{(tree / '.venv').resolve()} {python.resolve()}\n")
    return tree


@pytest.fixture
def make(tree: Path) -> Make:
    def run(*words: str, **environ: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["make", *words],
            cwd=tree,
            env={"PATH": os.environ["PATH"], **environ},
            capture_output=True,
            text=True,
            check=False,
        )

    return run


@pytest.mark.parametrize(
    ("words", "environ", "code", "told"),
    [
        ([], {}, 0, "deck run 09-brain\n"),
        (["PROFILE=02", "ARGS=--for 15 --set 'a.b=c d'"], {}, 0,
         "deck run 02 --for 15 --set a.b=c d\n"),
        ([], {"CODE": "1"}, 2, "deck run 09-brain\n"),
        ([], SOURCED, 0, "deck run 09-brain\n"),
        ([], {"PYTHONPATH": "/mine"}, 0, "deck run 09-brain\nPYTHONPATH=/mine\n"),
    ],
)  # fmt: skip
def test_what_make_run_runs(make: Make, words: list[str], environ: dict[str, str], code: int, told: str) -> None:
    ran = make("run", *words, **environ)
    assert (ran.returncode, ran.stdout) == (code, told)
