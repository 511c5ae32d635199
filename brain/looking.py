"""A picture to a model with vision: what is on it, and where."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from brain.situation import picture_part
from brain.thinking import think
from robot.commands.problems import CommandError, Problem
from robot.commands.wrapping import read_answer

if TYPE_CHECKING:
    from brain.client import Message
    from brain.ladder import Ladder
    from brain.thinking import Thought

Share = Annotated[float, Field(ge=0, le=1, description="Share of the width or height, 0 to 1")]
MOST_THINGS = 32
LONGEST_DESCRIPTION = 2000


class _StrictShape(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class PictureBox(_StrictShape):
    """Where something is on the picture; the origin is its upper left corner."""

    left: Share
    top: Share
    right: Share
    bottom: Share


class PictureThing(_StrictShape):
    """Something on the picture."""

    label: Annotated[str, Field(description="What it is, in one or two words")]
    box: PictureBox | None


class PictureSeen(_StrictShape):
    """What is on a picture."""

    description: Annotated[str, Field(description="What is on the picture, in a sentence or two")]
    things: Annotated[list[PictureThing], Field(description="What stands out, with boxes if you can")]


async def look(ladder: Ladder, prompt: str, jpeg: bytes) -> Thought[PictureSeen]:
    """Return what a model sees on a picture.

    Raises:
        ModelError: if there is no valid answer.
    """
    messages: list[Message] = [
        {"role": "system", "content": prompt},
        {"role": "user", "content": [picture_part(jpeg)]},
    ]
    return await think(ladder, PictureSeen.model_json_schema(), messages, parse_seen)


def parse_seen(text: str) -> PictureSeen:
    """Return what an answer says, shortened to what a message holds.

    Raises:
        CommandError: if it is no such answer. A box from right to left is one.
    """
    try:
        seen = PictureSeen.model_validate(read_answer(text).value)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise CommandError([Problem.of("invalid", first["loc"])]) from None
    for index, thing in enumerate(seen.things):
        box = thing.box
        if box is not None and not (box.left < box.right and box.top < box.bottom):
            raise CommandError([Problem.of("invalid", ("things", index, "box"))])
    description = seen.description.strip()[:LONGEST_DESCRIPTION]
    return PictureSeen(description=description, things=seen.things[:MOST_THINGS])
