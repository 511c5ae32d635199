"""A full disk and full shared memory: it is said, and nothing is kept from stopping.

On small file systems of a mount namespace, of a user's own unless it is root's anyhow.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.unit.profile_files import written

pytestmark = [pytest.mark.machine("namespaces"), pytest.mark.nightly]
ROOT = Path(__file__).resolve().parents[3]


def in_small_folder(folder: Path, size: str, *command: str) -> subprocess.CompletedProcess[str]:
    """Run a command for which `folder` is a file system of its own, of this size."""
    user = [] if os.getuid() == 0 else ["--user", "--map-root-user"]
    mount = f'mount -t tmpfs -o size={size} deck "$0" && exec "$@"'
    return subprocess.run(
        ["unshare", *user, "--mount", "sh", "-c", mount, str(folder), *command],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
        timeout=50,
    )


@pytest.fixture
def small(tmp_path: Path) -> Path:
    folder = tmp_path / "small"
    folder.mkdir()
    return folder


def test_a_full_disk_is_told_of_and_stops_nothing(
    tmp_path: Path, small: Path, ros_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DECK_LOG_DIR", str(small))
    many = "i=0; while [ $i -lt 3000 ]; do echo a line of some length, number $i; i=$((i+1)); done"
    path = written(
        tmp_path, f"nodes: {{a: {{exec: [sh, -c, '{many}; echo last']}}, b: {{exec: [sleep, 1]}}}}"
    )
    run = in_small_folder(
        small, "64k", sys.executable, "-m", "tui", "run", str(path), "--domain", str(ros_domain)
    )
    assert "No space left on device" in run.stdout
    assert "[a]    last" in run.stdout
    assert run.stdout.splitlines()[-1].startswith("every node stayed healthy")
    assert (run.returncode, run.stderr) == (0, "")


def test_a_recording_does_not_begin_where_the_disk_is_nearly_full(
    small: Path, ros_domain: int
) -> None:
    command = (sys.executable, "-m", "tui", "record", "--domain", str(ros_domain))
    run = in_small_folder(small, "100M", *command, "-o", str(small / "walk"))
    assert run.returncode == 2
    assert "are free on this disk, and 500 MB must stay free" in run.stderr
    assert "another disk" in run.stderr


def test_a_run_directory_that_takes_no_more_files_is_told_of(
    tmp_path: Path, small: Path, ros_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever it is that finds no room first: the folder, the record or the socket."""
    monkeypatch.setenv("DECK_RUN_DIR", str(small))
    path = written(tmp_path, "nodes: {a: {exec: [sleep, 60]}}")
    command = (sys.executable, "-m", "tui", "run", str(path), "--domain", str(ros_domain))
    told = []
    for files in range(2, 8):
        run = in_small_folder(small, f"64k,mode=700,nr_inodes={files}", *command, "--for", "0.1")
        if run.returncode == 0:
            break
        told.append(run.stderr)
        assert run.returncode == 2, run.stderr
        assert "No space left on device" in run.stderr
        assert "without a word" not in run.stderr
    assert len(told) >= 2


def test_shared_memory_without_room_is_told_of_once(small: Path) -> None:
    script = """
import sys
from pathlib import Path
from launcher.supervisor.shared_memory import SharedMemory

folder = Path(sys.argv[1])
memory = SharedMemory(lambda severity, words: print(severity.name, words), folder)
memory.clear()
(folder / "filler").write_bytes(bytes(3_500_000))
memory.clear()
memory.clear()
(folder / "filler").unlink()
memory.clear()
(folder / "filler").write_bytes(bytes(3_500_000))
memory.clear()
"""
    run = in_small_folder(small, "4m", sys.executable, "-c", script, str(small))
    words = f"ERROR {small} is full: nodes that start now may not hear the others;"
    assert [line.startswith(words) for line in run.stdout.splitlines()] == [True, True], run.stderr
