"""The app on a terminal, and a look for what of hostile text comes out of it as it was.

Each line is looked through twice: as widgets have drawn it, before the last look that Deck takes at
it, and as it is written to the terminal. Who shows text makes it plain, and does not leave that to
others.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from textual.drivers.headless_driver import HeadlessDriver
from textual.events import Key
from textual.filter import LineFilter

from tests.hostile_text import harm_in, harm_on_screen
from tests.tui.app_runs import LESSON_9
from tests.tui.snapshots import settle
from tests.waiting import until
from tui.app import DeckApp

if TYPE_CHECKING:
    from rich.segment import Segment
    from textual.color import Color
    from textual.pilot import Pilot

    from tui.session.ports import SessionOpener
    from tui.session.requests import OpenRequest

SIZE = (160, 50)
_NAMES = {">": "greater_than_sign", "<": "less_than_sign"}


class Writing(HeadlessDriver):
    """Keeps what a terminal would be given."""

    written: list[str]

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        self.written = []

    @property
    def is_headless(self) -> bool:
        """Have everything written."""
        return False

    def write(self, data: str) -> None:
        self.written.append(data)


class Noting(LineFilter):
    """Keeps the text of every line, and leaves the line as it is."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: set[str] = set()

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        del background
        self.lines.add("".join([segment.text for segment in segments if not segment.control]))
        return segments


class LookedThrough(DeckApp):
    """Keeps what its widgets draw."""

    def __init__(self, opener: SessionOpener, request: OpenRequest, screen: str) -> None:
        super().__init__(opener, request, screen, driver_class=Writing)
        self._noting = Noting()

    def get_line_filters(self) -> Sequence[LineFilter]:
        return [self._noting, *super().get_line_filters()]

    @property
    def drawn(self) -> str:
        """All lines as widgets have drawn them."""
        return "\n".join(sorted(self._noting.lines))

    @property
    def written(self) -> str:
        """All that a terminal would have been given."""
        assert isinstance(self._driver, Writing)
        return "".join(self._driver.written)


@dataclass
class Stage:
    """A test's hands and eyes."""

    app: LookedThrough
    pilot: Pilot[Any]

    async def press(self, *keys: str) -> None:
        """Press keys one by one, each to its end.

        A pilot would wait thrice for an idle processor, which takes most of the time.
        """
        for key in keys:
            name, character = _NAMES.get(key, key), key if len(key) == 1 else None
            self.app.post_message(Key(name, character))
            await self.pilot.pause()
            await until(self._at_rest, f"the end of what {key!r} begins")

    def _at_rest(self) -> bool:
        """Whether nothing is loaded or checked any more; the app's own work goes on."""
        return all(one.is_finished or one.node is self.app for one in self.app.workers)


@asynccontextmanager
async def looked_through(
    screen: str,
    opener: SessionOpener,
    order: OpenRequest = LESSON_9,
    *,
    all_plain: bool = True,
) -> AsyncIterator[Stage]:
    """Open a screen, and look at the end through all that came of it.

    `all_plain`: nothing was left to the last look.
    """
    app = LookedThrough(opener, order, screen)
    async with app.run_test(headless=False, size=SIZE) as pilot:
        await settle(pilot)
        yield Stage(app, pilot)
        await pilot.pause()
        drawn, written = app.drawn, app.written
    assert len(written) > 1000
    assert "evil" in written
    assert not harm_on_screen(written)
    left = harm_in(drawn.encode("utf-8", "surrogatepass"))
    assert bool(left) is not all_plain, left
