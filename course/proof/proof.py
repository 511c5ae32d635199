"""The proof of a lesson: what each of its variants comes to, and what it should."""

from __future__ import annotations

import asyncio
import tempfile
from collections.abc import AsyncIterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from course.lessons.lesson import WRONG, LessonFolder, Mistake
from course.proof.trial import Places, layered, trial
from course.results import State, StepResult
from launcher.errors import LauncherError
from launcher.profile.steps.draw import new_seed
from text.i18n import LANGUAGES
from text.sentences import reason_of, say

NODES_OF_ONE = 6
"""How many nodes a run may have that does not take the place of others."""


@dataclass(frozen=True)
class Variant:
    """One way of doing a lesson."""

    lesson: LessonFolder
    name: str
    """`starter`, `solution`, or `STEP/MISTAKE`."""
    layers: tuple[Path, ...]
    fails_at: str | None
    """The step that must fail, those before it having passed; None: none; empty: any."""
    mistake: Mistake | None = None


@dataclass(frozen=True)
class ProofVerdict:
    """What came of a variant."""

    variant: Variant
    complaint: str
    """Why it does not prove what it should; empty if it does."""
    seed: int = 0
    """What its values were drawn from; 0 if it was not run."""


def variants(lesson: LessonFolder) -> list[Variant]:
    base = (lesson.starter, lesson.solution)
    return [
        Variant(lesson, "starter", base[:1], ""),
        Variant(lesson, "solution", base, None),
        *(
            Variant(lesson, f"{mistake.step}/{mistake.name}", base, mistake.step, mistake)
            for mistake in lesson.mistakes()
        ),
    ]


def incomplete(lesson: LessonFolder) -> list[str]:
    """Return what a lesson lacks, without running anything."""
    missing: list[str] = []
    ids = [step.id for step in lesson.steps]
    if not ids:
        missing.append(say("lesson.yaml has no steps"))
    for language in LANGUAGES:
        file = lesson.path / f"text.{language}.md"
        if not file.is_file():
            missing.append(say("there is no {file}", file=file.name))
            continue
        sections = lesson.texts(language).sections
        missing += [
            say("{file} has no section ## {step}", file=file.name, step=step) for step in ids if step not in sections
        ]
        missing += [
            say("{file} has a section ## {step}, but there is no such step", file=file.name, step=name)
            for name in sections
            if name not in ids
        ]
    for folder in (lesson.starter, lesson.solution):
        if not folder.is_dir():
            missing.append(say("there is no folder {folder}", folder=folder.name))
    missing += [
        say("{file}: there is no step {step}", file=WRONG, step=one.step)
        for one in lesson.mistakes()
        if one.step not in ids
    ]
    if (lesson.path / "wrong").is_dir():
        missing.append(say("the folder wrong is not read: write its mistakes down in {file}", file=WRONG))
    return missing


async def prove(chosen: Sequence[Variant], domains: Sequence[int], *, seed: int = 0) -> AsyncIterator[ProofVerdict]:
    """Run variants, as many at once as there are domains; yield each verdict as it comes.

    One with many nodes takes the place of several.

    `seed`: what the values are drawn from, each time; 0: another one for each variant.
    """
    free: asyncio.Queue[int] = asyncio.Queue()
    for domain in domains:
        free.put_nowait(domain)

    taking = asyncio.Lock()

    async def one(variant: Variant) -> ProofVerdict:
        async with taking:  # Two that each hold a part would wait for each other.
            held = [await free.get() for _ in range(min(_weight(variant), len(domains)))]
        try:
            return await _proven(variant, held[0], seed or new_seed())
        finally:
            for domain in held:
                free.put_nowait(domain)

    # The longest come first, so that all jobs end at about the same time.
    tasks = [asyncio.ensure_future(one(each)) for each in sorted(chosen, key=_steps, reverse=True)]
    try:
        for task in asyncio.as_completed(tasks):
            yield await task
    finally:
        for each in tasks:
            each.cancel()
        with suppress(asyncio.CancelledError):
            await asyncio.gather(*tasks, return_exceptions=True)


def _weight(variant: Variant) -> int:
    """Return in the place of how many others it runs: many nodes keep a machine busy."""
    return 1 + len(variant.lesson.profile.nodes) // NODES_OF_ONE


def _steps(variant: Variant) -> int:
    """Return how many steps are judged, at least."""
    ids = [step.id for step in variant.lesson.steps]
    return ids.index(variant.fails_at) if variant.fails_at in ids else len(ids)


async def _proven(variant: Variant, domain: int, seed: int) -> ProofVerdict:
    with tempfile.TemporaryDirectory(prefix="deck-lesson-", ignore_cleanup_errors=True) as place:
        places = Places(Path(place), variant.lesson.name)
        places.make()
        layered(places.files, variant.layers)
        try:
            if variant.mistake is not None:
                variant.mistake.make(places.files)
            steps = await _until_it_fails(variant, places, domain, seed)
        except (LauncherError, OSError) as error:
            return ProofVerdict(variant, reason_of(error))
    return ProofVerdict(variant, _complaint(variant, steps), seed)


class _DecidedError(Exception):
    """A step has failed: what comes after it proves nothing."""


async def _until_it_fails(variant: Variant, places: Places, domain: int, seed: int) -> list[StepResult]:
    """Judge a variant up to the first step that does not pass, or to the one that must not."""
    steps: list[StepResult] = []

    def take(step: StepResult) -> None:
        steps.append(step)
        if step.state in (State.FAILED, State.UNJUDGED):
            raise _DecidedError

    with suppress(_DecidedError):
        async with trial(variant.lesson, places, seed=seed, domain=domain) as judge:
            await judge.once(take, until=variant.fails_at or "")
    return steps


def _complaint(variant: Variant, steps: Sequence[StepResult]) -> str:
    unjudged = next((step for step in steps if step.state is State.UNJUDGED), None)
    if unjudged is not None:
        return _of(unjudged)
    failed = [step for step in steps if step.state is State.FAILED]
    if variant.fails_at is None:
        return _of(failed[0]) if failed else ""
    if not failed:
        return say("every step passes, but {step} should fail", step=variant.fails_at or "-")
    if variant.fails_at and failed[0].id != variant.fails_at:
        return say("should fail at {wanted}, but: {found}", wanted=variant.fails_at, found=_of(failed[0]))
    return ""


def _of(step: StepResult) -> str:
    for check in step.checks:
        if check.state not in (State.PASSED, State.NOT_YET):
            return say("{step}: {what}: {seen}", step=step.id, what=check.what, seen=check.seen or check.state.value)
    return say("{step}: {why}", step=step.id, why=step.reason or step.state.value)
