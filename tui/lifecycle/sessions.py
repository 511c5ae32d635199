"""The session on the screen: opened, refused, closed, left; never more than one."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from launcher.errors import DomainTakenError, LauncherError
from text.i18n import _, said
from text.plain import plain
from tui.session.watching import WATCH

if TYPE_CHECKING:
    from textual.app import App

    from graph.replay.replay import Replay
    from launcher.status import SessionInfo, Stray
    from tui.emergency.control import EmergencyControl
    from tui.recording.recording import Recording
    from tui.screens import Screens
    from tui.session.feed import Feed
    from tui.session.ports import SessionLink, SessionOpener
    from tui.session.requests import OpenRequest
    from tui.session.strangers import Strangers


class Sessions:
    """The way into a session and out of it."""

    def __init__(
        self,
        app: App[Any],
        screens: Screens,
        feed: Feed,
        recording: Recording,
        emergency: EmergencyControl,
        strangers: Strangers,
        opener: SessionOpener,
        request: OpenRequest,
    ) -> None:
        """`opener` lists and opens; a `request` that names nothing is asked for by the picker."""
        self._app = app
        self._screens = screens
        self._feed = feed
        self._recording = recording
        self._emergency = emergency
        self._strangers = strangers
        self.opener = opener
        self.request = request
        """What every request has: hardware, overrides, domain; and what was named to begin with."""
        self.picking = not _name_of(request)
        """Whether the picker is where one comes from, and goes back to."""
        self.opening = "" if self.picking else _name_of(request)
        """What is being opened, empty if nothing is."""
        self.last_lesson = ""
        """The profile that was started last, where the list of lessons begins."""
        self.lesson_opened: Callable[[str], None] = lambda _name: None
        """Called with the profile that has been started."""
        self.parting_words = ""
        """Said on the terminal after the screen has gone."""
        self._strays_asked: set[Stray] = set()
        self._damaged: Replay | None = None
        """The recording of which it was told that it is damaged."""
        self._going_back = asyncio.Lock()
        """Held while the screens of a session that has been closed are taken away."""
        self._leaving = False
        self._stopping: SessionLink | None = None
        """The session that somebody here has asked to stop."""
        self._code = 0

    def begin(self) -> None:
        """Open what was named, if anything was."""
        if not self.picking:
            self.open(self.request)

    def open(self, request: OpenRequest) -> None:
        """Start or attach to a session and show it until it ends."""
        self._app.run_worker(self._open(request), exclusive=True, group="session")

    def close(self) -> None:
        """Stop the nodes that this screen has started, or let go of the others; then pick anew."""
        self._app.run_worker(self._close(), exclusive=True, group="leaving")

    def leave(self, code: int = 0) -> None:
        """Stop what this screen has started, and end with `code`; asked again, at once."""
        if self._leaving:
            self.stop_now()
            return
        self._leaving = True
        self._code = code
        self._app.run_worker(self._leave(), exclusive=True, group="leaving")

    def end_of_others(self) -> None:
        """Stop a session that was started elsewhere, if a person says so once more."""
        self._app.run_worker(self._end_of_others(), exclusive=True, group="leaving")

    async def ended(self, reason: str) -> None:
        """Say why the session on the screen is over, unless that was asked for here."""
        if self._stopping is None:
            words = plain(said(reason), 300)
            self._app.notify(words, severity="warning", timeout=30, markup=False)
        await self.let_go(reason)

    async def let_go(self, ended: str = "") -> None:
        """Let go of the session; stopping it is not done here."""
        # The recorder has threads of its own, and a bag to be ended in order.
        await self._recording.end()
        await self._feed.disconnect(ended)

    def stop_now(self) -> None:
        """Skip the waiting for nodes that do not end by themselves."""
        self._app.run_worker(self._stop_now(), group="leaving")

    def ask_about(self, found: Sequence[Stray]) -> None:
        """Offer to stop what an earlier run left behind, once."""
        strays = tuple(stray for stray in found if stray not in self._strays_asked)
        self._strays_asked.update(strays)
        if strays:
            self._app.run_worker(self._ask_about(strays), group="strays")

    async def _open(self, request: OpenRequest) -> None:
        app = self._app
        self.opening = _name_of(request)
        # The screens of the session before may be on their way out.
        async with self._going_back:
            pass
        opening = asyncio.create_task(self.opener.open(request))
        try:
            if self.picking:
                await self._screens.show("deck")
            link = await opening
        except DomainTakenError as error:
            await self._ask_for_domain(request, error)
            return
        except LauncherError as error:
            await self._refuse(error)
            return
        finally:
            opening.cancel()
            self.opening = ""
        if request.profile is not None:
            self.last_lesson = link.session.name
            self.lesson_opened(link.session.name)
        self._emergency.forget()
        self._strangers.forget()
        self._feed.connect(link, self.opener.observe(link.session))
        if self._feed.replay is not None:
            await self._show_recording(link.session)
        self._emergency.prepare()
        app.refresh_bindings()
        await self._feed.listen(self)
        app.refresh_bindings()

    async def _show_recording(self, session: SessionInfo) -> None:
        """Begin where there is something to see, and say what is missing of the recording."""
        if not session.panels:
            await self._screens.show("topics")
        replay = self._feed.replay
        if replay is not None and replay.state.cut:
            self._warn(replay.state.cut)

    def tell_damage(self, words: str) -> None:
        """Say that something in the recording cannot be read, when that is first come to."""
        replay = self._feed.replay
        if replay is not None and self._damaged is not replay:
            self._damaged = replay
            self._warn(words)

    def _warn(self, words: str) -> None:
        self._app.notify(plain(said(words), 600), severity="warning", timeout=20, markup=False)

    async def _refuse(self, error: LauncherError) -> None:
        """Say why nothing was opened: where it was picked, or by ending."""
        reason = words_of(error)
        if not self.picking or self._leaving:
            self.parting_words = reason
            self._app.exit(return_code=error.exit_code)
            return
        from tui.lifecycle.refused import RefusedScreen

        await self._back_to_picker()
        self._app.push_screen(RefusedScreen(reason))

    async def _ask_for_domain(self, request: OpenRequest, error: DomainTakenError) -> None:
        """Offer a domain in which there is no other session."""
        from tui.lifecycle.domain_taken import DomainAnswer, DomainTakenScreen

        answer = await self._app.push_screen_wait(DomainTakenScreen(_name_of(request), error))
        if answer is DomainAnswer.APART:
            self.open(request._replace(domain=error.free))
        elif answer is DomainAnswer.TOGETHER:
            self.open(request._replace(beside=True))
        elif self.picking:
            await self._back_to_picker()
        else:
            await self._refuse(error)

    async def _ask_about(self, strays: tuple[Stray, ...]) -> None:
        from tui.lifecycle.strays import StraysScreen

        wanted = await self._app.push_screen_wait(StraysScreen(strays))
        link = self._feed.link
        if wanted and link is not None:
            with contextlib.suppress(LauncherError):
                await link.stop_strays(strays)

    async def _close(self) -> None:
        async with self._going_back:
            await self._end()
            await self._back_to_picker()

    async def _leave(self) -> None:
        try:
            await self._end()
        finally:
            # Whatever failed on the way: who wants to leave does.
            self._app.exit(return_code=self._code)

    async def _stop_now(self) -> None:
        link = self._stopping
        if link is None or link is not self._feed.link:
            self._app.exit(return_code=self._code)
            return
        try:
            await link.shutdown(now=True)
        except LauncherError as error:
            # It hangs; what came of that is worth knowing when there is no screen any more.
            self.parting_words = words_of(error)

    async def _back_to_picker(self) -> None:
        """Go back to the list; the screens of the session go with it."""
        self.picking = True
        self._feed.close()
        await self._screens.show("picker")
        await self._screens.forget()

    async def _end(self) -> None:
        """Stop the session if it is this screen's own, else let go of it."""
        feed = self._feed
        if feed.link is None or not feed.link.own:
            self._say_what_is_left()
            await self.let_go()
            return
        await self._stop(feed.link)

    async def _stop(self, link: SessionLink) -> None:
        """Stop the nodes, with a dialog that shows what is waited for."""
        from tui.lifecycle.stopping import StoppingScreen

        app, graph = self._app, self._feed.graph
        self._stopping = link
        dialog = StoppingScreen()
        await app.push_screen(dialog)
        ending = [asyncio.ensure_future(link.shutdown())]
        if graph is not None:
            ending.append(asyncio.ensure_future(asyncio.to_thread(graph.stop)))
        for problem in await asyncio.gather(*ending, return_exceptions=True):
            if isinstance(problem, LauncherError):
                self.parting_words = words_of(problem)
        await self.let_go()
        self._stopping = None
        if dialog.is_running and app.screen is dialog:
            await dialog.dismiss()

    async def _end_of_others(self) -> None:
        from tui.lifecycle.end_session import EndSessionScreen

        link = self._feed.link
        if link is None or not self._feed.of_others:
            return
        wanted = await self._app.push_screen_wait(EndSessionScreen(link.session))
        if wanted and link is self._feed.link:
            async with self._going_back:
                await self._stop(link)
                await self._back_to_picker()

    def _say_what_is_left(self) -> None:
        """Name what goes on when this screen is left, and what ends it."""
        feed = self._feed
        # Whose terminal is gone reads nothing.
        if not feed.of_others or feed.session is None or not self._leaving or self._code:
            return
        session = feed.session
        if session.foreground:
            words = _("left as it is: {name} in domain {domain} ends with its own screen")
        else:
            words = _("left running: {name} in domain {domain}; `deck down {name}` ends it")
        self.parting_words = words.format(name=plain(session.name), domain=session.domain)


def words_of(error: LauncherError) -> str:
    """Return an error in the language spoken now, every problem of a profile on its line."""
    problems: Sequence[Any] = getattr(error, "problems", ())
    if not problems:
        return said(error.args[0]) if error.args else str(error)
    lines = []
    for problem in problems:
        field = f"{problem.field}: " if problem.field else ""
        hint = f" ({said(problem.hint)})" if problem.hint else ""
        lines.append(f"{problem.where}: {field}{said(problem.message)}{hint}")
    return "\n".join(lines)


def _name_of(request: OpenRequest) -> str:
    if request.replay is not None:
        # Path.resolve() raises for a link to itself.
        return Path(os.path.realpath(request.replay.bag)).stem
    if request.watch is not None:
        return WATCH
    return request.attach or (request.profile or Path()).stem
