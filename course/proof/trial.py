"""One run of a lesson on a folder of files: what a proof and a grading have in common."""

from __future__ import annotations

import asyncio
import contextlib
import shutil
from typing import TYPE_CHECKING

from course.judge.judge import judging
from course.lessons.lesson import IGNORED
from launcher.client.client import launch
from launcher.errors import LauncherError
from launcher.profile.defaults import FOLDERS_OWN
from launcher.profile.load import load_profile

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterable, Mapping
    from pathlib import Path
    from typing import Any

    from course.judge.judge import Judge
    from course.lessons.lesson import LessonFolder
    from course.proof.places import Places
    from launcher.client.start import StartingSupervisor
    from launcher.profile.model import Profile
    from launcher.profile.node import Node

PARTING_S = 12.0
"""How long the nodes may take to end when all has been judged."""


def layered(folder: Path, layers: Iterable[Path]) -> Path:
    """Copy folders into one, a later one over an earlier one; return it."""
    for layer in layers:
        if layer.is_dir():
            shutil.copytree(layer, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns(*IGNORED))
    return folder


@contextlib.asynccontextmanager
async def trial(
    lesson: LessonFolder,
    places: Places,
    *,
    seed: int,
    domain: int,
    confined: bool = True,
    language: str = "",
    functions: Mapping[str, Callable[[Any], object]] | None = None,
    supervisor: StartingSupervisor | None = None,
) -> AsyncIterator[Judge]:
    """Run the lesson.yaml of `places.files`, with a judge; all of it ends when this is left.

    Nodes of Deck run as always, all others confined to `places`, unless `confined` is false.

    Raises what `launch` raises.
    """
    profile = _at_home(load_profile(places.files / FOLDERS_OWN, domain=domain), lesson, places)
    client = await launch(
        profile, node_lang=language, supervisor=supervisor, confined_to=map(str, places.writable) if confined else ()
    )
    async with contextlib.aclosing(client):
        try:
            async with judging(lesson, client, seed, functions) as judge:
                yield judge
        finally:
            # Nobody needs to wait for nodes that do not want to end.
            with contextlib.suppress(LauncherError, asyncio.TimeoutError):
                await asyncio.wait_for(client.shutdown(now=True), PARTING_S)


def _at_home(profile: Profile, lesson: LessonFolder, places: Places) -> Profile:
    """Return the profile for nodes that work in these folders, and meet nobody on the network."""

    def at_home(node: Node) -> Node:
        if node.is_ours:
            return node.model_copy(update={"cwd": node.cwd or str(lesson.starter)})
        env = {**places.environment, **node.env}
        return node.model_copy(update={"cwd": node.cwd or str(places.files), "env": env})

    nodes = {name: at_home(node) for name, node in profile.nodes.items()}
    return profile.model_copy(update={"discovery": "localhost", "nodes": nodes})
