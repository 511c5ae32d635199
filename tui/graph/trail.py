"""Where one has been in the graph, to go back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tui.graph.place import Kind, Place

if TYPE_CHECKING:
    from collections.abc import Mapping

LONGEST = 100


class Trail:
    """The place of every kind that was chosen last, and the places that a link led away from."""

    def __init__(self) -> None:
        self.kind = Kind.NODE
        """What is listed."""
        self._chosen: dict[Kind, str] = {}
        self._been: list[Place] = []

    @property
    def here(self) -> Place | None:
        """The chosen place."""
        name = self._chosen.get(self.kind, "")
        return Place(self.kind, name) if name else None

    @property
    def chosen(self) -> Mapping[Kind, str]:
        """What was chosen last of each kind."""
        return self._chosen

    def choose(self, name: str) -> None:
        """Choose another of the same kind, as one does who walks down the list."""
        self._chosen[self.kind] = name

    def go(self, place: Place) -> None:
        """Follow a link; `back` returns from there."""
        here = self.here
        if here is not None and here != place:
            self._been = [*self._been, here][-LONGEST:]
        self._set(place)

    def back(self) -> bool:
        """Return to where the newest link was followed; False if there is none."""
        if self._been:
            self._set(self._been.pop())
            return True
        return False

    def forget(self) -> None:
        """Begin anew."""
        self._chosen.clear()
        self._been.clear()

    def _set(self, place: Place) -> None:
        self.kind = place.kind
        self._chosen[place.kind] = place.name
