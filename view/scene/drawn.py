"""What a message becomes: archetypes of Rerun at a place in its tree of entities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

LONGEST_NAME = 200
IMPLICIT = "tf#"
"""Rerun's own names of frames begin with it."""
WORLD = "tf#/"
"""The frame of the 3D view, in which the roots of the trees of frames are put."""

Message: TypeAlias = "Mapping[str, Any]"
"""A decoded message, see `graph.data.Value`."""


class UnusableMessageError(ValueError):
    """A message that nobody can draw; its text is a sentence that says what is wrong with it."""

    def __init__(self, words: str, drawn: Sequence[Drawn] = ()) -> None:
        """`drawn` is what could be drawn of it."""
        super().__init__(words)
        self.drawn = drawn


@dataclass(frozen=True)
class Drawn:
    """What is logged at one entity; later ones replace it."""

    path: tuple[str, ...]
    shapes: tuple[Any, ...]
    """Archetypes of Rerun."""
    frame: str = ""
    """The frame they are given in, empty for what is in none."""
    static: bool = False
    """Whether it holds for all times, and is kept however long the viewer runs."""
    recursive: bool = False
    """Whether `shapes` is empty and everything below is removed."""


def frame_name(text: object) -> str:
    """Return a frame's name as it is shown, without a leading slash."""
    name = plain(str(text).lstrip("/"), LONGEST_NAME)
    return f"_{name}" if name.startswith(IMPLICIT) else name


def topic_path(root: str, topic: str, *more: str) -> tuple[str, ...]:
    """Return the entity of a topic below `root`."""
    return (root, *(part for part in topic.split("/") if part), *more)
