"""Recording from the screen: started and stopped with a key, shown in the title.

It ends with the session. Everything that touches the disk or ROS runs in threads; here it is only
requested and reported.
"""

from __future__ import annotations

import asyncio
import math
import re
from typing import TYPE_CHECKING, Any, NamedTuple

from text.i18n import _, localized
from text.plain import plain
from tui.recording.words import complaints, is_low, length_words, low_words, progress, rate_words, size_words

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from textual.app import App
    from textual.timer import Timer

    from graph.recording.recorder import Recorder, RecordingStatus
    from launcher.status import SessionInfo
    from tui.session.feed import Feed

LOOK_S = 1.0
SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0, "с": 1.0, "мин": 60.0, "ч": 3600.0}
BYTES = {"kb": 1e3, "mb": 1e6, "gb": 1e9, "кб": 1e3, "мб": 1e6, "гб": 1e9}
_LIMIT = re.compile(r"([0-9]{1,9}(?:[.,][0-9]{1,3})?)\s*([^\W\d_]*)\.?")


class RecordingLimit(NamedTuple):
    """When a recording ends by itself; infinite: never."""

    seconds: float = math.inf
    bytes: float = math.inf

    def is_reached(self, status: RecordingStatus) -> bool:
        """Return whether the recording has lasted so long, or is so large."""
        return status.seconds >= self.seconds or status.bytes >= self.bytes


class RecordingWish(NamedTuple):
    """A recording that somebody wants."""

    folder: Path
    """It does not exist yet."""
    left_out: frozenset[str] = frozenset()
    """Types of messages that are not recorded."""
    limit: RecordingLimit = RecordingLimit()


def read_limit(text: str) -> RecordingLimit:
    """Return the limit that somebody has typed: `10 min`, `90 s`, `1 h`, `500 MB`, `2 GB`.

    A number alone means minutes, an empty text no limit.

    Raises:
        ValueError: if it is none of these, with words for the user.
    """
    words = text.strip().casefold()
    if not words:
        return RecordingLimit()
    found = _LIMIT.fullmatch(words)
    number = 0.0 if found is None else float(found[1].replace(",", "."))
    unit = "" if found is None else found[2] or "min"
    if number <= 0 or unit not in SECONDS | BYTES:
        raise ValueError(_("expected a time or a size: 10 min, 90 s, 1 h, 500 MB, 2 GB"))
    if unit in SECONDS:
        return RecordingLimit(seconds=number * SECONDS[unit])
    return RecordingLimit(bytes=number * BYTES[unit])


class Recording:
    """The recording of the session on the screen, if there is one."""

    def __init__(self, app: App[Any], feed: Feed, key: Callable[[], str]) -> None:
        """Record the session of `feed`, and notify in `app`; `key` names the key that stops it."""
        self._app = app
        self._feed = feed
        self._key = key
        self._recorder: Recorder | None = None
        self._timer: Timer | None = None
        self._busy = asyncio.Lock()
        self._slow_told = self._low_told = False
        self._limit = RecordingLimit()
        self.left_out: frozenset[str] = frozenset()
        """The types that were left out the last time."""

    @property
    def active(self) -> bool:
        return self._recorder is not None

    @property
    def status(self) -> RecordingStatus | None:
        """Its current state, None while nothing is being recorded."""
        return None if self._recorder is None else self._recorder.status

    @property
    def words(self) -> Sequence[str]:
        """The texts for the title, the longest first: `● rec 12 s 3.4 MB 80 kB/s`, or none."""
        status = self.status
        if status is None:
            return ()
        length, size = length_words(status.seconds), size_words(status.bytes)
        short = _("● rec {length} {size}").format(length=length, size=size)
        return (f"{short} {rate_words(status.bytes_per_s)}", short, f"● {size}")

    def begin(self, wish: RecordingWish) -> None:
        """Start it; nothing happens if one is under way."""
        self.left_out = wish.left_out
        self._app.run_worker(self._begin(wish), group="recording")

    def end_soon(self) -> None:
        """Stop it, without waiting for that."""
        self._app.run_worker(self.end(), group="recording")

    async def end(self) -> None:
        """Stop it if it is running, and say where it is."""
        async with self._busy:
            recorder, self._recorder = self._recorder, None
            if self._timer is not None:
                self._timer.stop()
            if recorder is None:
                return
            self._changed()
            self._tell(await asyncio.to_thread(recorder.stop))

    async def _begin(self, wish: RecordingWish) -> None:
        from graph.bag.errors import BagError

        async with self._busy:
            session = self._feed.session
            if session is None or self.active:
                return
            try:
                recorder = await asyncio.to_thread(_started, session, wish)
            except BagError as error:
                self._complain(localized(error.words))
                return
            self._recorder, self._limit = recorder, wish.limit
            self._slow_told = self._low_told = False
            self._timer = self._app.set_interval(LOOK_S, self._look)
        folder = plain(recorder.status.folder, 400)
        words = _("Recording into {folder}; {key} ends it.")
        self._app.notify(words.format(folder=folder, key=self._key()), markup=False)
        self._changed()

    def _look(self) -> None:
        """Update the title, and report problems as they occur."""
        status = self.status
        if status is None:
            return
        if status.ended or status.error:
            self.end_soon()
        elif self._limit.is_reached(status):
            self._app.notify(_("The recording ends as it was asked to."), markup=False)
            self.end_soon()
        elif status.slow and not self._slow_told:
            self._slow_told = True
            self._complain(_("The disk does not keep up with the recording."))
        elif is_low(status) and not self._low_told:
            self._low_told = True
            words = _("Recording: {words}.")
            self._complain(words.format(words=low_words(status)))
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
        front = self._feed.front
        if front is not None:
            front.show_frame()
        self._app.refresh_bindings()


def _started(session: SessionInfo, wish: RecordingWish) -> Recorder:
    """Start recording the whole session but for what is left out."""
    from graph.recording.recorder import Recorder

    recorder = Recorder(session.domain, session.discovery, wish.folder, without=wish.left_out)
    recorder.start()
    return recorder
