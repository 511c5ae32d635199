"""Finding lessons: those of Deck, in `./lessons`, and in the learner's course folder."""

from __future__ import annotations

import os
from pathlib import Path

from course.lessons.lesson import LessonFolder, folders
from launcher.errors import UsageError
from launcher.profile.catalog import fitting, meant
from launcher.profile.defaults import FOLDERS_OWN
from launcher.profile.model import Profile
from text.sentences import say
from text.suggestions import did_you_mean

SHIPPED = Path(__file__).resolve().parents[2] / "lessons"
COURSE = "DECK_COURSE"


def course_dir() -> Path:
    """Return the folder in which the learner works: `DECK_COURSE`, else `~/deck-course`."""
    chosen = os.environ.get(COURSE)
    return Path(chosen).expanduser().absolute() if chosen else Path.home() / "deck-course"


def lessons() -> dict[str, LessonFolder]:
    """Return all lessons by name; a later place overrides an earlier one."""
    places = (SHIPPED, course_dir() / "lessons", Path("lessons"))
    found = {
        folder.name: LessonFolder(folder.absolute())
        for place in places
        for folder in folders(place)
        if (folder / FOLDERS_OWN).is_file()
    }
    return dict(sorted(found.items()))


def find_lesson(name: str | Path) -> LessonFolder:
    """Return a lesson by folder, name, number or start of a name.

    Raises:
        UsageError: if there is none, or if there are several.
    """
    text = str(name)
    known = lessons()
    if (Path(text) / FOLDERS_OWN).is_file() and (os.sep in text or text not in known):
        # `..` is a name as little as `.` is.
        return LessonFolder(Path(os.path.abspath(text)))  # noqa: PTH100
    chosen = meant(text, known)
    if chosen is not None:
        return known[chosen]
    hint = did_you_mean(text, known) or say("there are: {names}", names=", ".join(known))
    raise UsageError(say("there is no lesson {name!r}; {hint}", name=text, hint=hint))


def next_lesson(lesson: LessonFolder) -> LessonFolder | None:
    """Return the lesson that comes after one; None after the last."""
    known = lessons()
    return next((known[name] for name in known if name > lesson.name), None)


def lesson_of(profile: Profile) -> LessonFolder | None:
    """Return the lesson that a profile belongs to, by its number; None if there is none."""
    number = profile.lesson
    if number:
        fits = fitting(number, lessons())
        return lessons()[fits[0]] if len(fits) == 1 else None
    return lessons().get(profile.name)
