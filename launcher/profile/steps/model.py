"""The steps of a lesson and the values that differ from run to run."""

from __future__ import annotations

import re
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from launcher.parts import Texts, refuse
from launcher.profile.steps.checks import Check, Document
from text.sentences import say

STEP_ID = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
VALUE_NAME = re.compile(r"[a-z][a-z0-9_]*")


def _id(value: object) -> object:
    if isinstance(value, str) and not STEP_ID.fullmatch(value):
        raise refuse(say("{value!r} is not an id; write small letters, digits and -", value=value))
    return value


def _names(value: object) -> object:
    for name in value if isinstance(value, dict) else ():
        if not VALUE_NAME.fullmatch(name):
            raise refuse(say("{name!r} is not a name for a value; write it as near_m", name=name))
    return value


class ValueDocument(Document):
    """A value that is drawn anew in each run: exactly one of `between` and `one_of`."""

    between: tuple[float, float] | None = Field(
        None, strict=False, description="A number between these; whole if both are whole."
    )
    digits: int | None = Field(None, ge=0, le=6, description="With between: decimal places.")
    one_of: tuple[Any, ...] = Field((), strict=False, description="One of these.")


class StepDocument(Document):
    """One step of a lesson."""

    id: Annotated[str, BeforeValidator(_id)] = Field(
        description="Its name, also that of its section in text.en.md: `rate`."
    )
    title: Texts = Field({}, description="A line, by language.")
    points: int = Field(1, ge=0, le=1000)
    file: str | None = Field(None, description="The learner's file that this step is about.")
    needs: tuple[str, ...] = Field(
        (), strict=False, description="Steps that must have passed before this one is judged."
    )
    checks: tuple[Check, ...] = Field(strict=False, min_length=1, description="What must be seen, in order.")
    hints: tuple[Texts, ...] = Field(
        (), strict=False, max_length=3, description="Shown one after the other when asked for."
    )


Values = Annotated[dict[str, ValueDocument], BeforeValidator(_names)]
