"""Recording from the screen: begun and ended by a key, shown in the title, ended with the session.

All that touches the disk or ROS is done on threads; here it is only asked for and told.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from text.plain import plain
from tui.i18n import _, said
from tui.recording_words import complaints, length_words, progress, size_words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.timer import Timer

    from graph.recording import Recorder, RecordingStatus
    from launcher.status import SessionInfo
    from tui.app import DeckApp

LOOK_S = 1.0


class Recording:
    """The recording of the session on the screen, if there is one."""

    def __init__(self, app: DeckApp) -> None:
        """Record the session of `app`."""
        self._app = app
        self._recorder: Recorder | None = None
        self._timer: Timer | None = None
        self._busy = asyncio.Lock()
        self._slow_told = False

    @property
    def active(self) -> bool:
        """Whether it records."""
        return self._recorder is not None

    @property
    def status(self) -> RecordingStatus | None:
        """How it stands, None while nothing is recorded."""
        return None if self._recorder is None else self._recorder.status

    @property
    def words(self) -> Sequence[str]:
        """What the title says of it, from long to short: nothing, or `● rec 12 s 3.4 MB`."""
        status = self.status
        if status is None:
            return ()
        length, size = length_words(status.seconds), size_words(status.bytes)
        return (_("● rec {length} {size}").format(length=length, size=size), f"● {size}")

    def toggle(self) -> None:
        """Begin, or end."""
        self._app.run_worker(self.end() if self.active else self._begin(), group="recording")

    async def end(self) -> None:
        """End it, if there is one, and say where it is."""
        async with self._busy:
            recorder, self._recorder = self._recorder, None
            if self._timer is not None:
                self._timer.stop()
            if recorder is None:
                return
            self._changed()
            self._tell(await asyncio.to_thread(recorder.stop))

    async def _begin(self) -> None:
        from graph.bag_errors import BagError
        from launcher.errors import LauncherError

        async with self._busy:
            session = self._app.feed.session
            if session is None or self.active:
                return
            try:
                recorder = await asyncio.to_thread(_started, session)
            except BagError as error:
                self._complain(said(error.words))
                return
            except LauncherError as error:
                self._complain(said(error.args[0]))
                return
            self._recorder = recorder
            self._slow_told = False
            self._timer = self._app.set_interval(LOOK_S, self._look)
        folder = plain(recorder.status.folder, 400)
        words = _("Recording into {folder}; {key} ends it.")
        key = self._app.keys_of(_toggle())[0]
        self._app.notify(words.format(folder=folder, key=key), markup=False)
        self._changed()

    def _look(self) -> None:
        """Keep the title true, and say what goes wrong when it does."""
        status = self.status
        if status is None:
            return
        if status.ended or status.error:
            self.toggle()
        elif status.slow and not self._slow_told:
            self._slow_told = True
            self._complain(_("The disk does not keep up with the recording."))
        self._changed()

    def _tell(self, status: RecordingStatus) -> None:
        """Say where it is, and what is wrong with it."""
        for sentence in complaints(status):
            self._complain(sentence)
        words = _("Recorded: {words}\n{folder}")
        folder = plain(status.folder, 400)
        self._app.notify(words.format(words=progress(status), folder=folder), markup=False)

    def _complain(self, sentence: str) -> None:
        self._app.notify(plain(sentence, 400), severity="warning", markup=False)

    def _changed(self) -> None:
        front = self._app.feed.front
        if front is not None:
            front.show_frame()
        self._app.refresh_bindings()


def _toggle() -> type:
    from tui.actions.recording import RecordToggle

    return RecordToggle


def _started(session: SessionInfo) -> Recorder:
    """Begin to record everything of the session, where `deck replay` finds it by its name."""
    from graph.recording import Recorder
    from launcher.rundir import new_recording

    recorder = Recorder(session.domain, session.discovery, new_recording(session.name))
    recorder.start()
    return recorder
