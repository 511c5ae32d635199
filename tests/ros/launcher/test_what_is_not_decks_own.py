"""Nothing that Deck has not made itself is removed, changed or opened to others by it."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from launcher.rundir import run_dir
from tests.ros.supervised import SLEEPER, Launch, running_pid, script, start
from tests.waiting import until

__all__ = ["start"]

SPEAKER = script("import time; print('hello', flush=True); time.sleep(1000)")


def mode(path: Path) -> int:
    return stat.S_IMODE(path.lstat().st_mode)


def deck(*words: str, **environ: str) -> subprocess.CompletedProcess[str]:
    """Run `deck` to its end."""
    return subprocess.run(
        [sys.executable, "-m", "tui", *words],
        env={**os.environ, **environ},
        capture_output=True,
        text=True,
        check=False,
    )


async def test_folders_of_a_person_among_the_logs_stay(start: Launch, tmp_path: Path) -> None:
    """Fifteen of them, some called as a run is: of twelve runs only Deck's own oldest go."""
    logs = tmp_path / "logs" / "test"
    trips = [logs / f"holiday-{day}" for day in range(8)]
    trips += [logs / f"202501{day:02}-000000-999999-1" for day in range(1, 8)]
    for folder in trips:
        folder.mkdir(parents=True)
        (folder / "picture.png").write_text("precious")
    (logs / "linked").symlink_to(trips[0])
    before = sorted(logs.iterdir())
    for _ in range(2):
        client = await start({"node": {"exec": SLEEPER}})
        await running_pid(client, "node")
        await client.shutdown(now=True)
    assert [path for path in before if not path.is_symlink() and not list(path.iterdir())] == []
    assert [path for path in before if not path.exists()] == []


async def test_a_folder_of_the_users_own_serves_as_run_directory_and_stays_as_it_is(
    start: Launch, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = tmp_path / "home"
    (home / "deck").mkdir(parents=True)
    home.chmod(0o755)
    record = home / "session" / "session.json"
    record.parent.mkdir()
    record.write_text("{}")
    monkeypatch.setenv("DECK_RUN_DIR", str(home))
    client = await start({"node": {"exec": SLEEPER}})
    await running_pid(client, "node")
    assert mode(home / client.session.run_id) == 0o700
    await client.shutdown(now=True)
    assert mode(home) == 0o755
    assert sorted(path.name for path in home.iterdir()) == ["deck", "session"]
    assert record.exists()


async def test_what_a_person_has_put_into_the_folder_of_a_run_stays(start: Launch) -> None:
    client = await start({"node": {"exec": SLEEPER}})
    await running_pid(client, "node")
    folder = run_dir() / client.session.run_id
    (folder / "notes.txt").write_text("mine")
    await client.shutdown(now=True)
    assert [path.name for path in folder.iterdir()] == ["notes.txt"]


async def test_whatever_the_umask_logs_and_sockets_are_the_users_only(
    start: Launch, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DECK_LOG_DIR", str(tmp_path / "state" / "deck" / "logs"))
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "runtime" / "run"))
    before = os.umask(0)
    try:
        client = await start({"node": {"exec": SPEAKER}})
        log = Path(client.session.log_dir, "node.log")
        await until(lambda: log.exists() and bool(log.read_text()), "a line in the log")
    finally:
        os.umask(before)
    made = [*(tmp_path / "state").rglob("*"), *(tmp_path / "runtime").rglob("*")]
    made += [tmp_path / "state", tmp_path / "runtime"]
    assert {path.name for path in made} >= {"node.log", "supervisor.log", "control.sock"}
    assert {str(path): oct(mode(path)) for path in made if mode(path) & 0o077} == {}
