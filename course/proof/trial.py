"""One run of a lesson on a folder of files, in a domain and a run of its own, to the end."""

from __future__ import annotations

import shutil
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from course.judge.judge import judging
from course.lessons.lesson import IGNORED
from launcher.client.client import launch
from launcher.profile.defaults import FOLDERS_OWN
from launcher.profile.load import load_profile

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterable

    from course.lessons.lesson import LessonFolder
    from course.results import LessonResult, StepResult
    from launcher.client.client import SupervisorClient
    from launcher.client.start import StartingSupervisor


def layered(folder: Path, layers: Iterable[Path]) -> Path:
    """Copy folders into one, a later one over an earlier one; return it."""
    for layer in layers:
        if layer.is_dir():
            shutil.copytree(
                layer, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns(*IGNORED)
            )
    return folder


async def trial(
    lesson: LessonFolder,
    folder: Path,
    *,
    seed: int,
    domain: int | None = None,
    until: str = "",
    on_step: Callable[[StepResult], object] = lambda _: None,
    supervisor: StartingSupervisor | None = None,
) -> LessonResult:
    """Run the lesson.yaml of a folder, judge it once by the steps of the lesson, and end it.

    Raises what `launch` raises.
    """
    async with (
        running(folder, domain, supervisor) as client,
        judging(lesson, client, seed) as judge,
    ):
        return await judge.once(until=until, on_step=on_step)


@asynccontextmanager
async def running(
    folder: Path, domain: int | None, supervisor: StartingSupervisor | None = None
) -> AsyncIterator[SupervisorClient]:
    """Have the lesson.yaml of a folder run; its nodes have ended when this is left."""
    profile = load_profile(folder / FOLDERS_OWN, domain=domain)
    client = await launch(profile, supervisor=supervisor)
    try:
        yield client
    finally:
        await client.shutdown()
