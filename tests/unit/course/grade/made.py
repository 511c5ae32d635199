"""Grades as they come of a lesson, made without running anything."""

from __future__ import annotations

from datetime import datetime, timezone
from pathlib import Path

from course.grade.grades import Grade, StepGrade
from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder
from course.results import CheckResult, State, StepResult
from text.sentences import InLanguages, say

LESSON = LessonFolder(SHIPPED / "02-sonar-safety")
STATES = (State.PASSED, State.FAILED, State.WAITS, State.PASSED, State.PASSED)
HOSTILE = "=cmd|'/c calc'!A1 \x1b[31m\x00]]> <b> & \ud800 \N{RIGHT-TO-LEFT OVERRIDE}"


def grade(*states: State, student: str = "alice", reason: str = "", said: str = "it is 7") -> Grade:
    steps = tuple(
        StepGrade(
            step,
            StepResult(
                step.id,
                state,
                step.points,
                ()
                if state is State.WAITS
                else (
                    CheckResult(
                        state,
                        say("{topic} comes", topic="/sensor"),
                        "" if state is State.PASSED else say("found {said}", said=said),
                        "" if state is State.PASSED else InLanguages({"en": "Look.", "ru": "Вот."}),
                    ),
                ),
                say("waits for: {steps}", steps="topic") if state is State.WAITS else "",
            ),
            1.25,
        )
        for step, state in zip(LESSON.steps, states or STATES, strict=True)
    )
    began = datetime(2026, 6, 1, 14, 32, 5, tzinfo=timezone.utc)
    return Grade(LESSON, student, Path("/class/alice"), steps, began, 9.876, 7, {"near_m": 0.3}, reason)
