"""The problems of a profile, collected."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from launcher.errors import ProfileProblem
from text.yaml_tree import FilePlace, field_name

if TYPE_CHECKING:
    from text.yaml_faults import YamlError
    from text.yaml_tree import Where


@dataclass
class Problems:
    """Collects problems, so that all can be reported at once."""

    found: list[ProfileProblem] = field(default_factory=list)

    def add(self, place: FilePlace, where: Where, message: str, hint: str = "") -> None:
        """Add a problem; duplicates count once."""
        problem = ProfileProblem(place.file, place.line, place.column, field_name(where), message, hint)
        if problem not in self.found:
            self.found.append(problem)

    def take(self, file: str, error: YamlError) -> None:
        """Add an error in the YAML of a file."""
        self.add(FilePlace(file, error.line, error.column), error.where, error.message)

    def in_order(self) -> tuple[ProfileProblem, ...]:
        """Return the problems ordered by file and line."""
        return tuple(sorted(self.found, key=lambda each: (each.file, each.line, each.column)))
