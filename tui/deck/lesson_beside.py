"""The lesson beside the nodes of the Deck, where that is wished and fits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tui.frame.host import host_of

if TYPE_CHECKING:
    from textual.screen import Screen

    from tui.lesson.column import LessonColumn
    from tui.session.messages import SessionChanged

ROOM = (120, 34)
"""Columns and rows of the terminal from which it fits."""


class LessonBesideNodes:
    """Puts the column of the lesson onto the `#desk` of a screen; the wish is the app's."""

    def __init__(self, screen: Screen[None]) -> None:
        """Start without it: its modules are not needed for the first frame."""
        self._screen = screen
        self._column: LessonColumn | None = None

    @property
    def fits(self) -> bool:
        return self._screen.size.width >= ROOM[0] and self._screen.size.height >= ROOM[1]

    async def toggle(self) -> None:
        """Show it, or not any more."""
        from tui.lesson.at_work import LessonAtWork

        at_work = LessonAtWork.of(self._screen)
        at_work.beside_nodes = not at_work.beside_nodes
        await self._bring()

    def measure_room(self) -> None:
        """Hide it if it does not fit."""
        if self._column is not None:
            self._column.display = self.fits

    async def session_changed(self, message: SessionChanged) -> None:
        await self._bring()
        if self._column is not None:
            self._column.session_changed(self._screen, message)

    def status_changed(self) -> None:
        """Show how the learner's nodes are."""
        if self._column is not None:
            self._column.status_changed(self._screen)

    async def _bring(self) -> None:
        lesson = host_of(self._screen).lesson
        wished = lesson is not None and lesson.beside_nodes
        if wished and self._column is None:
            from tui.lesson.at_work import LessonAtWork
            from tui.lesson.column import LessonColumn

            self._column = LessonColumn(LessonAtWork.of(self._screen))
            self.measure_room()
            await self._screen.query_one("#desk").mount(self._column, before="#board")
            self._column.follow(self._screen)
        elif self._column is not None and not wished:
            await self._column.remove()
            self._column = None
