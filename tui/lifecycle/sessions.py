"""The session on the screen: opening it, refusing to, closing it, leaving it; at most one."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from launcher.errors import DomainTakenError, LauncherError
from launcher.profile.defaults import name_of
from text.i18n import _, localized
from text.plain import plain
from text.sentences import reason_of
from tui.session.messages import LessonOpened
from tui.session.watching import WATCH

if TYPE_CHECKING:
    from textual.app import App

    from graph.replay.replay import Replay
    from launcher.status import SessionInfo, Stray
    from tui.emergency.control import EmergencyControl
    from tui.recording.recording import Recording
    from tui.screens import Screens
    from tui.session.bypass import BypassDetector
    from tui.session.feed import Feed
    from tui.session.ports import SessionLink, SessionOpener
    from tui.session.requests import OpenRequest


class Sessions:
    """Opens and closes sessions."""

    def __init__(
        self,
        app: App[Any],
        screens: Screens,
        feed: Feed,
        recording: Recording,
        emergency: EmergencyControl,
        bypass: BypassDetector,
        opener: SessionOpener,
        request: OpenRequest,
    ) -> None:
        """Start with `opener`, which lists and opens; an empty `request` shows the picker."""
        self._app = app
        self._screens = screens
        self._feed = feed
        self._recording = recording
        self._emergency = emergency
        self._bypass = bypass
        self.opener = opener
        self.request = request
        """Hardware, overrides and domain for every request, and the profile named at the start."""
        self.picking = not _name_of(request)
        """Whether sessions are opened from the picker, and closing one returns to it."""
        self.opening = "" if self.picking else _name_of(request)
        """Name of the session that is being opened, empty if there is none."""
        self.last_lesson = ""
        """The profile that was started last, where the list of lessons starts."""
        self.parting_words = ""
        """Printed on the terminal after the screen has closed."""
        self._strays_asked: set[Stray] = set()
        self._damaged: Replay | None = None
        """The recording that has been reported as damaged."""
        self._going_back = asyncio.Lock()
        """Held while the screens of a closed session are being removed."""
        self._leaving = False
        self._stopping: SessionLink | None = None
        """The session that is being stopped at the user's request."""
        self._code = 0

    def begin(self) -> None:
        if not self.picking:
            self.open(self.request)

    def open(self, request: OpenRequest) -> None:
        """Start or attach to a session, and show it until it ends."""
        self._app.run_worker(self._open(request), exclusive=True, group="session")

    def move_to(self, request: OpenRequest) -> None:
        """Close the session on the screen, and open another."""
        self._app.run_worker(self._move_to(request), exclusive=True, group="leaving")

    def close(self) -> None:
        """Stop the nodes that this screen started, or detach from others; then show the picker."""
        self._app.run_worker(self._close(), exclusive=True, group="leaving")

    def leave(self, code: int = 0) -> None:
        """Stop what this screen has started, and exit with `code`; if asked again, exit at once."""
        if self._leaving:
            self.stop_now()
            return
        self._leaving = True
        self._code = code
        self._app.run_worker(self._leave(), exclusive=True, group="leaving")

    def end_of_others(self) -> None:
        """Stop a session that was started elsewhere, after the user confirms."""
        self._app.run_worker(self._end_of_others(), exclusive=True, group="leaving")

    async def ended(self, reason: str) -> None:
        """Say why the session on the screen has ended, unless it was stopped from here."""
        if self._stopping is None:
            words = plain(localized(reason), 300)
            self._app.notify(words, severity="warning", timeout=30, markup=False)
        await self.let_go(reason)

    async def let_go(self, ended: str = "") -> None:
        """Disconnect from the session without stopping it."""
        # The recorder has threads of its own, and must close its bag properly.
        await self._recording.end()
        await self._feed.disconnect(ended)

    def stop_now(self) -> None:
        """Stop waiting for nodes that do not end by themselves."""
        self._app.run_worker(self._stop_now(), group="leaving")

    def ask_about(self, found: Sequence[Stray]) -> None:
        """Offer once to stop processes that an earlier run left behind."""
        strays = tuple(stray for stray in found if stray not in self._strays_asked)
        self._strays_asked.update(strays)
        if strays:
            self._app.run_worker(self._ask_about(strays), group="strays")

    async def _open(self, request: OpenRequest) -> None:
        app = self._app
        self.opening = _name_of(request)
        # The screens of the previous session may still be closing.
        async with self._going_back:
            pass
        opening = asyncio.create_task(self.opener.open(request))
        try:
            if self.picking:
                await self._screens.show(request.screen)
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
            app.post_message(LessonOpened(link.session.name))
        self._bypass.forget()
        self._feed.connect(link, self.opener.observe(link.session), self.opener.replay)
        self._emergency.begin()
        if self._feed.replay is not None:
            await self._show_recording(link.session)
        with contextlib.suppress(LauncherError):  # It may just have ended.
            await link.attend()
        self._emergency.prepare()
        app.refresh_bindings()
        await self._feed.listen(self)
        app.refresh_bindings()

    async def _show_recording(self, session: SessionInfo) -> None:
        """Show a screen with content, and report what is missing in the recording."""
        if not session.panels:
            await self._screens.show("topics")
        replay = self._feed.replay
        for words in replay.state.notes if replay is not None else ():
            self._warn(words)

    def tell_damage(self, words: str) -> None:
        """Report that part of the recording cannot be read, when playback first gets there."""
        replay = self._feed.replay
        if replay is not None and self._damaged is not replay:
            self._damaged = replay
            self._warn(words)

    def _warn(self, words: str) -> None:
        self._app.notify(plain(localized(words), 600), severity="warning", timeout=20, markup=False)

    async def _refuse(self, error: LauncherError) -> None:
        """Say why nothing was opened: in the picker, or by exiting."""
        reason = words_of(error)
        if not self.picking or self._leaving:
            self.parting_words = reason
            self._app.exit(return_code=error.exit_code)
            return
        from tui.lifecycle.dialogs import RefusedScreen

        await self._back_to_picker()
        self._app.push_screen(RefusedScreen(reason))

    async def _ask_for_domain(self, request: OpenRequest, error: DomainTakenError) -> None:
        """Offer a domain without another session."""
        from tui.lifecycle.dialogs import DomainAnswer, DomainTakenScreen

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
        from tui.lifecycle.dialogs import StraysScreen

        wanted = await self._app.push_screen_wait(StraysScreen(strays))
        link = self._feed.link
        if wanted and link is not None:
            with contextlib.suppress(LauncherError):
                await link.stop_strays(strays)

    async def _close(self) -> None:
        async with self._going_back:
            await self._end()
            await self._back_to_picker()

    async def _move_to(self, request: OpenRequest) -> None:
        await self._close()
        self.open(request)

    async def _leave(self) -> None:
        try:
            if self._code:
                # Without its terminal, this process does not outlive nodes that take their time.
                await self._recording.end()
            await self._end()
        finally:
            # Even if something has failed, the user wants to leave.
            self._app.exit(return_code=self._code)

    async def _stop_now(self) -> None:
        link = self._stopping
        if link is None or link is not self._feed.link:
            self._app.exit(return_code=self._code)
            return
        try:
            await link.shutdown(now=True)
        except LauncherError as error:
            # The supervisor hangs; the result is still worth knowing after the screen has closed.
            self.parting_words = words_of(error)

    async def _back_to_picker(self) -> None:
        """Go back to the list, and remove the screens of the session."""
        self.picking = True
        self._emergency.forget()
        self._feed.close()
        await self._screens.show("picker")
        await self._screens.forget()

    async def _end(self) -> None:
        """Stop the session if this screen owns it, otherwise detach from it."""
        feed = self._feed
        if feed.link is None or not feed.link.own:
            self._say_what_is_left()
            await self.let_go()
            return
        await self._stop(feed.link)

    async def _stop(self, link: SessionLink) -> None:
        """Stop the nodes, with a dialog that shows which are still running."""
        from tui.lifecycle.dialogs import StoppingScreen

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
        from tui.lifecycle.dialogs import EndSessionScreen

        link = self._feed.link
        if link is None or not self._feed.of_others:
            return
        wanted = await self._app.push_screen_wait(EndSessionScreen(link.session))
        if wanted and link is self._feed.link:
            async with self._going_back:
                await self._stop(link)
                await self._back_to_picker()

    def _say_what_is_left(self) -> None:
        """Say what keeps running after this screen is left, and how to stop it."""
        feed = self._feed
        # With the terminal gone, nobody would read it.
        if not feed.of_others or feed.session is None or not self._leaving or self._code:
            return
        session = feed.session
        if session.foreground:
            words = _("left as it is: {name} in domain {domain} ends with its own screen")
        else:
            words = _("left running: {name} in domain {domain}; `deck down {name}` ends it")
        self.parting_words = words.format(name=plain(session.name), domain=session.domain)


def words_of(error: LauncherError) -> str:
    """Return an error in the current language, one line for each problem of a profile."""
    problems: Sequence[Any] = getattr(error, "problems", ())
    if not problems:
        return localized(reason_of(error))
    lines = []
    for problem in problems:
        field = f"{problem.field}: " if problem.field else ""
        hint = f" ({localized(problem.hint)})" if problem.hint else ""
        lines.append(f"{problem.where}: {field}{localized(problem.message)}{hint}")
    return "\n".join(lines)


def _name_of(request: OpenRequest) -> str:
    if request.replay is not None:
        # Path.resolve() raises an error for a link to itself.
        return Path(os.path.realpath(request.replay.bag)).stem
    if request.watch is not None:
        return WATCH
    return request.attach or name_of(request.profile or Path())
