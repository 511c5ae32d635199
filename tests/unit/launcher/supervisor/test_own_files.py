"""What is saved before anything is watched is not missed, and is told once."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from launcher.faults.rules import imports
from launcher.faults.source import look_at
from launcher.supervisor.own_files import OwnFiles
from tests.waiting import until


class Watched:
    """The file of one node, watched."""

    def __init__(self, file: Path) -> None:
        self.saves: list[str] = []
        self.files = OwnFiles(lambda: {"own": str(file)}, lambda node, _: self.saves.append(node))
        self._tasks: list[asyncio.Task[None]] = []

    def begin(self) -> None:
        """Watch from now on."""
        self._tasks.append(asyncio.create_task(self.files.watch()))

    async def end(self) -> None:
        """Watch no more."""
        for task in self._tasks:
            task.cancel()
        await asyncio.wait(self._tasks)


@pytest.fixture
async def watched(tmp_path: Path) -> AsyncIterator[Watched]:
    (tmp_path / "beside.py").write_text("number = 1\n")
    (tmp_path / "own.py").write_text("import beside\n")
    watched = Watched(tmp_path / "own.py")
    yield watched
    await watched.end()


@pytest.mark.parametrize("saved", ["own.py", "beside.py"])
async def test_what_is_saved_after_the_start_and_before_the_watch_counts(
    watched: Watched, tmp_path: Path, saved: str
) -> None:
    watched.files.note("own", str(tmp_path / "own.py"))
    (tmp_path / saved).write_text("import beside  # saved\n")
    watched.begin()
    await until(lambda: watched.saves, "the save is told")
    # Told once: the next one is of another save.
    watched.files.look_again()
    (tmp_path / "own.py").write_text("import beside  # saved again\n")
    await until(lambda: len(watched.saves) > 1, "the next save is told")
    assert watched.saves == ["own", "own"]


def test_a_module_of_the_course_that_is_missing_is_not_called_misspelled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(imports, "KNOWN", (*imports.KNOWN, "absent_msgs", "absent_srvs"))
    own = tmp_path / "own.py"
    own.write_text("import absent_msgs\n")
    fault = look_at(str(own))
    assert fault is not None
    assert "The message package absent_msgs is not here" in fault.meaning
    own.write_text("import absent_msg\n")
    fault = look_at(str(own))
    assert fault is not None
    assert "did you mean absent_msgs?" in fault.meaning
