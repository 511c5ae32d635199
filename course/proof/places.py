"""Where the nodes of one who is judged work and write: folders in one place of their own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True)
class Places:
    """The folders of one run. Nodes of Deck write in none of them: links in them may lead away."""

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
