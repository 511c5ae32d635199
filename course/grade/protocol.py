"""The messages between the grader and an examiner: a line of JSON each, over a socket.

One request; then `values` once the nodes are started, `step` for each step, `end` at the end. A
socket, since the other end of a pipe can be opened by every process of the same user.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

from course.protocol import MOST_BYTES
from text.nested import read_json

if TYPE_CHECKING:
    from typing_extensions import Self

__all__ = ["MOST_BYTES", "ExamRequest"]


@dataclass(frozen=True)
class ExamRequest:
    """What an examiner is to do."""

    lesson: str
    """The folder of the lesson."""
    place: str
    """The folder in which all of it happens, see `course.proof.places`."""
    confined: bool
    """Whether the learner's nodes are kept in it."""
    domain: int
    seed: int
    within_s: float
    """How long all of it may take."""
    language: str
    """The one that nodes log in."""
    bag: str = ""
    """The folder of a recording, which does not exist yet; empty: none is made."""

    def to_json(self) -> str:
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, line: bytes) -> Self:
        """Read the output of `to_json`."""
        return cls(**read_json(line))
