"""The marks by which `make` knows an environment that is whole from one that is not."""

from __future__ import annotations

import hashlib
import subprocess
import sys
import threading
import zipfile
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest

from tests.unit.scripts_of_setup import ROOT, load
from tests.waiting import wait_until

environment = load("environment")
LOG = Path("/dev/null")


@pytest.fixture
def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """A tree with a blank in its name, an environment in it, and nothing installed for real."""
    tree = tmp_path / "a tree"
    tree.mkdir()
    (tree / "scripts").symlink_to(ROOT / "scripts")
    subject = environment.Environment(tree / ".venv")
    steps: list[str] = []
    monkeypatch.delenv("PYTHON", raising=False)

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


def shell_says_sound(tree: Path) -> bool:
    """Ask what the Makefile asks before each target."""
    return subprocess.call(["/bin/sh", "scripts/sound.sh"], cwd=tree) == 0


def both_say_sound(made: SimpleNamespace) -> bool:
    """The shell and Python read the same marks and must agree."""
    sound: bool = made.subject.is_sound()
    assert shell_says_sound(made.tree) == sound
    return sound


def test_an_environment_is_sound_when_its_set_up_has_ended(made: SimpleNamespace) -> None:
    assert not both_say_sound(made)
    made.subject.update()
    assert made.steps == ["Virtual environment", "install"]
    assert both_say_sound(made)


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


def test_what_is_left_of_an_earlier_environment_goes(made: SimpleNamespace, tmp_path: Path) -> None:
    """Without what its links lead to."""
    made.subject.update()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "precious").touch()
    (made.subject.folder / "lib64").symlink_to(tmp_path / "elsewhere")
    (made.subject.folder / "stale").mkdir()
    made.subject.ready.write_text("of another place")
    made.subject.update()
    assert sorted(path.name for path in made.subject.folder.iterdir()) == [".ready", "bin"]
    assert (tmp_path / "elsewhere" / "precious").exists()


def test_a_sound_environment_is_brought_up_to_date_in_place(made: SimpleNamespace) -> None:
    made.subject.update()
    made.steps.clear()
    made.subject.update()
    assert made.steps == ["install"]


def test_a_moved_tree_is_not_sound(made: SimpleNamespace) -> None:
    made.subject.update()
    moved = made.tree.rename(made.tree.with_name("elsewhere"))
    assert not shell_says_sound(moved)
    assert not environment.Environment(moved / ".venv").is_sound()


def test_an_environment_whose_python_is_gone_is_not_sound(made: SimpleNamespace) -> None:
    made.subject.update()
    made.subject.python.unlink()
    made.subject.python.symlink_to("/nowhere/python3")
    assert not both_say_sound(made)


def test_an_environment_of_another_python_than_asked_for_is_not_sound(
    made: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    made.subject.update()
    monkeypatch.setattr(sys, "executable", "/bin/sh")
    assert made.subject.is_sound()
    monkeypatch.setenv("PYTHON", "/bin/sh")
    assert not made.subject.is_sound()


def test_a_killed_set_up_is_begun_anew(
    made: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half an installation looks whole to pip."""
    made.subject.update()

    def killed(_self: object) -> None:
        raise ChildProcessError("killed by signal 9")

    with monkeypatch.context() as patch:
        patch.setattr(environment.Environment, "install", killed)
        with pytest.raises(ChildProcessError):
            made.subject.update()
    assert not both_say_sound(made)
    made.steps.clear()
    made.subject.update()
    assert made.steps == ["Virtual environment", "install"]
    assert both_say_sound(made)


def test_a_set_up_that_failed_for_want_of_a_network_harms_nothing(
    made: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    made.subject.update()
    before = made.subject.ready.stat().st_mtime_ns

    def fails(_self: object) -> None:
        raise environment.StepError("libraries", LOG)

    monkeypatch.setattr(environment.Environment, "install", fails)
    with pytest.raises(environment.StepError):
        made.subject.update()
    assert both_say_sound(made)
    assert made.subject.ready.stat().st_mtime_ns == before


def test_a_failing_step_shows_the_end_of_its_log_and_where_it_lies(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(environment, "WORK", tmp_path)

    def fails(_self: object) -> None:
        words = "import sys; print(*range(100), sep='\\n', flush=True); sys.exit('no network')"
        environment.Step("Libraries", sys.executable, "-c", words).finish()

    monkeypatch.setattr(environment.Environment, "update", fails)
    assert environment.main(str(tmp_path)) == 1
    said = capsys.readouterr()
    assert said.out == ""
    assert "no network" in said.err
    assert "\n50\n" not in said.err
    assert said.err.endswith(f"{tmp_path / 'libraries.log'}\n")


def test_a_tree_that_cannot_be_written_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setattr(environment, "WORK", tmp_path / "file" / "build")
    assert environment.main(str(tmp_path / ".venv")) == 1
    assert "deck: cannot set up here" in capsys.readouterr().err.splitlines()[-1]


def test_the_message_types_are_built_again_only_when_they_change(tmp_path: Path) -> None:
    (tmp_path / "msg").mkdir()
    definition = tmp_path / "msg" / "Point.msg"
    definition.write_text("float64 x\n")
    before = environment.fingerprint(tmp_path)
    definition.touch()
    assert environment.fingerprint(tmp_path) == before
    definition.rename(definition.with_name("Spot.msg"))
    assert environment.fingerprint(tmp_path) != before


def test_a_second_make_waits_and_finds_the_work_done(
    made: SimpleNamespace, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(environment, "ROOT", made.tree)
    monkeypatch.setattr(environment, "WORK", made.tree / "build")
    held = threading.Event()

    def first() -> None:
        with environment.only_one():
            held.set()
            wait_until(lambda: "waiting" in capsys.readouterr().err, "the word of the second")
            made.subject.update()

    thread = threading.Thread(target=first)
    thread.start()
    held.wait()
    environment.set_up(made.subject)
    thread.join()
    assert made.steps == ["Virtual environment", "install"]


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

    monkeypatch.setattr(environment, "WORK", tmp_path / "work")
    monkeypatch.setattr(environment, "Step", step)
    monkeypatch.setattr(environment.subprocess, "run", run)
    (tmp_path / "work" / "wheels").mkdir(parents=True)
    environment.Environment(tmp_path).install_deck()
    environment.build_interfaces(tmp_path / "work" / "wheels", tmp_path / "build")
    installs = [words for words in commands if "install" in words or "wheel" in words]
    assert len(installs) == 4
    for words in installs:
        assert "--require-hashes" in words or {"--no-deps", "--no-build-isolation"} <= {*words}
    files = [Path(words[-1]).name for words in installs if "--require-hashes" in words]
    assert files == ["deck.txt", "interfaces.txt"]


def test_a_newer_release_of_what_is_locked_changes_nothing(tmp_path: Path) -> None:
    """Pip asks for a library with an extra anew, though the file has the library without one."""
    index = tmp_path / "index"
    index.mkdir()
    needs = wheel(index, "needs", "1.0", "library[extra]>=1.0")
    locked = wheel(index, "library", "1.0")
    wheel(index, "library", "2.0")
    wanted = tmp_path / "locked.txt"
    wanted.write_text(f"needs==1.0 --hash={needs}\nlibrary==1.0 --hash={locked}\n")
    here = ("--no-index", "--find-links", index, "--target", tmp_path / "installed")
    subprocess.run(
        environment.pip(Path(sys.executable), *environment.REQUIRE, wanted, *here), check=True
    )
    names = {path.name for path in (tmp_path / "installed").glob("*.dist-info")}
    assert names == {"needs-1.0.dist-info", "library-1.0.dist-info"}


def wheel(folder: Path, name: str, version: str, *requires: str) -> str:
    """Write a wheel that holds nothing but its metadata, and return the hash of its file."""
    path = folder / f"{name}-{version}-py3-none-any.whl"
    inside = f"{name}-{version}.dist-info"
    needed = "".join(f"Requires-Dist: {line}\n" for line in requires)
    with zipfile.ZipFile(path, "w") as file:
        about = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        file.writestr(f"{inside}/METADATA", f"{about}Provides-Extra: extra\n{needed}")
        kind = "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
        file.writestr(f"{inside}/WHEEL", kind)
        file.writestr(f"{inside}/RECORD", "")
    return f"sha256:{hashlib.sha256(path.read_bytes()).hexdigest()}"


def test_what_is_abandoned_ends_with_all_that_it_has_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(environment, "WORK", tmp_path)
    monkeypatch.setattr(environment, "ROOT", tmp_path)
    step = environment.Step("Build", "/bin/sh", "-c", "sleep 60 & echo $!; wait")
    log = tmp_path / "build.log"
    wait_until(lambda: log.read_text().endswith("\n"), "the child to be started")
    child = psutil.Process(int(log.read_text()))
    step.abandon()
    wait_until(
        lambda: not child.is_running() or child.status() == psutil.STATUS_ZOMBIE,
        "the child to end",
    )


def test_a_build_goes_elsewhere_from_a_path_that_shells_do_not_take(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(environment, "WORK", tmp_path / "a tree")
    with environment.folder_for_cmake() as folder:
        assert folder == tmp_path / "a tree" / "build-environment"
    monkeypatch.setattr(environment, "WORK", tmp_path / "o'brien")
    with environment.folder_for_cmake() as folder:
        assert "'" not in str(folder)
        (folder / "half").touch()
    assert not folder.exists()


def test_on_a_terminal_the_seconds_of_a_step_are_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(environment, "WORK", tmp_path)
    monkeypatch.setattr(environment, "ROOT", tmp_path)
    monkeypatch.setattr(environment, "TICK_S", 0.01)
    monkeypatch.setattr(environment.Step, "ended", 2)
    monkeypatch.setattr(environment.Step, "total", 5)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    told: list[str] = []

    def say(text: str, end: str = "\n") -> None:
        told.append(text + end)
        if len(told) == 3:
            (tmp_path / "go").touch()

    monkeypatch.setattr(environment, "say", say)
    environment.Step("Build", "/bin/sh", "-c", "until [ -e go ]; do sleep 0.01; done").finish()
    assert all(line.startswith("\r  3 of 5: Build ... ") for line in told[:3])
    assert told[-1].startswith("\r\x1b[K  3 of 5: Build ... ")
    assert told[-1].endswith(" s\n")
