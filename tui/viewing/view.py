"""The viewer in 3D of the session on the screen: opened with a key, ended with the session."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from text.i18n import _
from tui.viewing.dialog import ViewDialog
from tui.viewing.process import NotOpenedError, ViewProcess, start_view

if TYPE_CHECKING:
    from textual.app import App
    from textual.timer import Timer

    from tui.session.feed import Feed

LOOK_S = 1.0
FAULT_S = 20.0
"""How long it is shown why there is no viewer: it may name a command to type."""


class View:
    """The viewer, if one is open."""

    def __init__(self, app: App[Any], feed: Feed) -> None:
        """Show the session of `feed`, and notify in `app`."""
        self._app = app
        self._feed = feed
        self._process: ViewProcess | None = None
        self._domain = -1
        self._timer: Timer | None = None
        self._busy = asyncio.Lock()

    def open(self) -> None:
        self._app.run_worker(self._open(), group="view")

    async def end(self) -> None:
        process, self._process = self._process, None
        if self._timer is not None:
            self._timer.stop()
        if process is not None:
            await process.end()

    async def _open(self) -> None:
        if self._busy.locked():
            return
        async with self._busy:
            session = self._feed.session
            if session is None:
                return
            if self._process is not None and not self._process.ended:
                self._show(self._process)
                return
            self._app.notify(_("Opening the viewer…"), timeout=2, markup=False)
            try:
                process = await start_view(session.domain)
            except NotOpenedError as error:
                self._complain(str(error))
                return
            self._process, self._domain = process, session.domain
            self._timer = self._app.set_interval(LOOK_S, self._look)
            self._show(process)

    def _show(self, process: ViewProcess) -> None:
        self._app.push_screen(ViewDialog(process.opened, self._stop))

    def _stop(self) -> None:
        self._app.run_worker(self.end(), group="view")

    async def _look(self) -> None:
        """End it with its session, and say so if it has broken."""
        session, process = self._feed.session, self._process
        if process is None:
            return
        if process.ended:
            await self.end()
            if fault := await process.fault():
                self._complain(fault)
        elif session is None or self._feed.link is None or session.domain != self._domain:
            await self.end()

    def _complain(self, words: str) -> None:
        self._app.notify(words, title=_("There is no viewer"), severity="warning", timeout=FAULT_S, markup=False)
