"""One run of a lesson on a folder of files, and where its nodes work: what a proof and a grading have in common."""

from __future__ import annotations

import asyncio
import contextlib
import random
import shutil
from collections.abc import AsyncIterator, Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from course.judge.judge import Judge, judging
from course.lessons.lesson import IGNORED, LessonFolder
from launcher.client.client import launch
from launcher.client.start import StartingSupervisor
from launcher.domain.domain import LAST_SAFE_DOMAIN, default_domain
from launcher.errors import LauncherError, UsageError
from launcher.profile.defaults import FOLDERS_OWN
from launcher.profile.load import load_profile
from launcher.profile.model import Profile
from launcher.profile.node import Node
from launcher.runs.record import supervisors
from text.sentences import say

PARTING_S = 12.0
"""How long the nodes may take to end when all has been judged."""


def layered(folder: Path, layers: Iterable[Path]) -> Path:
    """Copy folders into one, a later one over an earlier one; return it."""
    for layer in layers:
        if layer.is_dir():
            shutil.copytree(layer, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns(*IGNORED))
    return folder


@dataclass(frozen=True)
class Places:
    """The folders in which the nodes of one run work and write; not those of Deck: links in them may lead away."""

    root: Path
    lesson: str
    """The name of the lesson's folder."""

    @property
    def files(self) -> Path:
        """The copy of the learner's files."""
        return self.root / "files" / self.lesson

    @property
    def writable(self) -> tuple[Path, ...]:
        """All of them. Logs are in none: the supervisor writes those, and keeps them small."""
        return (self.files, *map(self._of_nodes, ("tmp", "ros", "state")))

    @property
    def environment(self) -> dict[str, str]:
        """The variables that keep the learner's nodes in them."""
        return {
            "TMPDIR": str(self._of_nodes("tmp")),
            "ROS_LOG_DIR": str(self._of_nodes("ros")),
            "DECK_STATE_DIR": str(self._of_nodes("state")),
        }

    def make(self) -> None:
        for folder in self.writable:
            folder.mkdir(parents=True, exist_ok=True)

    def _of_nodes(self, name: str) -> Path:
        return self.root / "nodes" / name


@contextlib.asynccontextmanager
async def trial(
    lesson: LessonFolder,
    places: Places,
    *,
    seed: int,
    domain: int,
    within: Sequence[str] = (),
    language: str = "",
    functions: Mapping[str, Callable[[Any], object]] | None = None,
    supervisor: StartingSupervisor | None = None,
) -> AsyncIterator[Judge]:
    """Run the lesson.yaml of `places.files`, with a judge; all of it ends when this is left.

    `within`: the beginning of a command line that confines a program; for all nodes but those of Deck.

    Raises what `launch` raises.
    """
    profile = _at_home(load_profile(places.files / FOLDERS_OWN, domain=domain), lesson, places)
    client = await launch(profile, node_lang=language, supervisor=supervisor, within=within)
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
            return replace(node, cwd=node.cwd or str(lesson.starter))
        env = {**places.environment, **node.env}
        return replace(node, cwd=node.cwd or str(places.files), env=env)

    nodes = {name: at_home(node) for name, node in profile.nodes.items()}
    return profile.model_copy(update={"discovery": "localhost", "nodes": nodes})


def unused_domains(count: int) -> list[int]:
    """Return so many domains in which no session of this user runs, nor would by default.

    They are drawn, so that two proofs at the same time hardly ever meet.

    Raises:
        UsageError: if there is none.
    """
    taken = {default_domain(), *(one.domain for one in supervisors())}
    free = [domain for domain in range(1, LAST_SAFE_DOMAIN + 1) if domain not in taken]
    if not free:
        raise UsageError(say("no ROS domain is free: `deck ps` shows what runs in them, `deck down` stops it"))
    return random.SystemRandom().sample(free, min(count, len(free)))
