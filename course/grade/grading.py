"""Grading folders, several at once, each by an examiner of its own that may come to any harm."""

from __future__ import annotations

import asyncio
import hashlib
import shutil
import tempfile
import time
from collections.abc import AsyncGenerator, Callable, Sequence
from contextlib import aclosing
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from course.folder.folder import in_language
from course.grade.examination import ExamRequest, examined, own_places
from course.grade.grades import Grade, StepGrade, filled_up
from course.grade.limits import remove_tree
from course.grade.submission import Files, Submission, check_gradable, files_of
from course.grade.walls import cell, room
from course.lessons.lesson import LessonFolder
from course.proof.trial import Places, unused_domains
from course.results import State, StepResult
from launcher.errors import UsageError
from launcher.profile.defaults import FOLDERS_OWN
from launcher.profile.steps.draw import LARGEST_SEED
from launcher.wire import unpack
from text.i18n import LANGUAGES
from text.packing import unpack_text
from text.sentences import reason_of, say

WITHIN_S = 180.0
"""How long one folder may take."""
ATTEMPTS = 3
"""In how many domains it is tried, if somebody else is in the first."""
BAG = Path("own", "bag")


@dataclass(frozen=True)
class Terms:
    """How to grade; the same for all folders."""

    lesson: LessonFolder
    seed: int = 0
    """What the values are drawn from; 0: other files, another one, see `seed_of`."""
    bags: Path | None = None
    """Where to keep recordings."""
    within_s: float = WITHIN_S
    language: str = "en"
    bubblewrap: str = ""
    """The program that makes walls, see `course.grade.walls`; empty: nothing is confined."""


async def grade_all(
    terms: Terms,
    chosen: Sequence[Submission],
    *,
    jobs: int = 1,
    domains: Sequence[int] = (),
    on_step: Callable[[Submission, StepGrade], object] = lambda _submission, _step: None,
) -> AsyncGenerator[tuple[int, Grade], None]:
    """Grade folders, so many at once; yield each grade as it comes, with its folder's number.

    All folders, and the lesson's starter, are read before anything is run: what one learner's nodes do to the files
    of another, where nothing keeps them from it, is not judged.

    `domains`: the ROS domains to do it in, each used as late again as can be; none: some that nobody is in.
    """
    free: asyncio.Queue[int] = asyncio.Queue()
    for domain in domains or unused_domains(64):
        free.put_nowait(domain)
    check_gradable(terms.lesson)
    starter = await asyncio.to_thread(Files.read, terms.lesson.starter)
    read = [await asyncio.to_thread(_read, one.folder) for one in chosen]
    space = asyncio.Semaphore(jobs)
    # What comes with the lesson is for every learner to see, and may be run by it.
    within_lesson = terms.lesson.path.resolve()
    folders = [submission.folder for submission in chosen]
    apart = [each for each in folders if within_lesson not in each.resolve().parents]

    async def one(number: int) -> tuple[int, Grade]:
        submission, files = chosen[number], read[number]
        async with space:
            if not isinstance(files, Files):
                return number, _not_graded(terms, submission, files)
            return number, await _Grading(terms, submission, starter, files, free, on_step, apart).grade()

    tasks = [asyncio.ensure_future(one(number)) for number in range(len(chosen))]
    try:
        for task in asyncio.as_completed(tasks):
            yield await task
    finally:
        for each in tasks:
            each.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


def seed_of(files: Files) -> int:
    """Return what the values for these files are drawn from: each time the same.

    So the same files get the same grade in the same words. Whoever writes the values into a file
    has made another one, for which others are drawn.
    """
    found = hashlib.sha256()
    for path, content in sorted(files.contents.items()):
        found.update(f"{path} {len(content)} ".encode(errors="surrogateescape"))
        found.update(content)
    return int.from_bytes(found.digest()[:8], "big") % LARGEST_SEED + 1


def _read(folder: Path) -> Files | str:
    try:
        return Files.read(folder)
    except UsageError as error:
        return reason_of(error)


def _not_graded(terms: Terms, submission: Submission, reason: str) -> Grade:
    steps = filled_up(terms.lesson, (), State.UNJUDGED, reason)
    began = datetime.now(timezone.utc)
    return Grade(terms.lesson, submission.student, submission.folder, steps, began, reason=reason)


@dataclass
class _Grading:
    """The grading of one folder."""

    terms: Terms
    submission: Submission
    starter: Files
    files: Files
    domains: asyncio.Queue[int]
    """Those in which nobody is graded."""
    on_step: Callable[[Submission, StepGrade], object]
    apart: Sequence[Path]
    """The folders of all learners, hidden from each."""

    def __post_init__(self) -> None:
        self._names = files_of(self.terms.lesson)
        self._missing = [name for name in self._names if Path(name) not in self.files.contents]
        self._seed = self.terms.seed or seed_of(self.files)
        self._grade = replace(_not_graded(self.terms, self.submission, ""), steps=(), notes=self._remarks())

    def _remarks(self) -> tuple[str, ...]:
        """Return what its teacher should know of the folder."""
        notes: list[str] = []
        if self._missing:
            names = ", ".join(self._missing)
            notes.append(say("not in the folder: {files}; the lesson's own beginning of it was judged", files=names))
        own = self.files.contents.get(Path(FOLDERS_OWN))
        given = self.starter.contents[Path(FOLDERS_OWN)]
        if own not in (None, given, *(in_language(given, code) for code in LANGUAGES)):
            notes.append(say("the folder's {file} was not used, but the lesson's own", file=FOLDERS_OWN))
        return tuple(notes)

    async def grade(self) -> Grade:
        """Grade it; whatever happens, the result is a grade."""
        began_s = time.monotonic()
        if self._names and self._missing == self._names:
            reason = say("none of the lesson's files is there: {files}", files=", ".join(self._names))
            steps = filled_up(self.terms.lesson, (), State.FAILED, reason)
            for step in steps:
                self.on_step(self.submission, step)
            return replace(self._grade, steps=steps, notes=())
        for _attempt in range(ATTEMPTS):
            domain = await self.domains.get()
            try:
                again = await self._in_domain(domain)
            finally:
                self.domains.put_nowait(domain)
            if not again:
                break
        why = self._grade.reason or say("it was not judged")
        steps = filled_up(self.terms.lesson, self._grade.steps, State.UNJUDGED, why)
        return replace(self._grade, steps=steps, seed=self._seed, seconds=time.monotonic() - began_s)

    async def _in_domain(self, domain: int) -> bool:
        """Grade it in this domain; return whether somebody else is there."""
        terms, taken = self.terms, False
        place = Path(await asyncio.to_thread(tempfile.mkdtemp, prefix="deck-grade-"))
        try:
            request = self._prepared(place, domain)
            walls = room(terms.bubblewrap, terms.lesson, place, self.apart) if terms.bubblewrap else ()
            async with aclosing(examined(place, request, walls)) as events:
                async for event in events:
                    self._take(event)
                    taken = event.get("taken", False)
            await asyncio.to_thread(self._keep_bag, place)
            return taken and not self._grade.steps
        finally:
            await asyncio.to_thread(remove_tree, place)

    def _prepared(self, place: Path, domain: int) -> ExamRequest:
        terms = self.terms
        places = Places(place, terms.lesson.name)
        places.make()
        for own in own_places(place).values():
            own.mkdir(parents=True)
        self.starter.write(places.files)
        self.files.write(places.files, without=FOLDERS_OWN)
        return ExamRequest(
            lesson=str(terms.lesson.path),
            place=str(place),
            cell=cell(terms.bubblewrap, place, places.writable) if terms.bubblewrap else (),
            domain=domain,
            seed=self._seed,
            within_s=terms.within_s,
            language=terms.language,
            bag="" if terms.bags is None else str(place / BAG),
        )

    def _keep_bag(self, place: Path) -> None:
        """Move the recording to where it was asked for: an examiner writes nowhere else."""
        if self.terms.bags is None or not (place / BAG).is_dir():
            return
        folder = self.terms.bags.absolute() / self.submission.student.replace("/", "-")
        shutil.rmtree(folder, ignore_errors=True)  # Of an attempt in another domain
        folder.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(place / BAG, folder)
        self._grade = replace(self._grade, bag=folder)

    def _take(self, event: dict[str, Any]) -> None:
        grade = self._grade
        if event["event"] == "values":
            self._grade = replace(grade, values=event["values"])
        elif event["event"] == "note":
            self._grade = replace(grade, notes=(*grade.notes, unpack_text(event["words"])))
        elif event["event"] == "end":
            self._grade = replace(grade, reason=event["reason"])
        else:
            result = unpack(StepResult, event["step"])
            document = next(step for step in self.terms.lesson.steps if step.id == result.id)
            known = {one.step.id: one for one in grade.steps}
            # One that is reported again has been judged before; something was found out since.
            seconds = known[result.id].seconds if result.id in known else float(event["seconds"])
            known[result.id] = StepGrade(document, result, seconds)
            self._grade = replace(grade, steps=tuple(known.values()))
            self.on_step(self.submission, known[result.id])
