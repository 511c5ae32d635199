"""A picture source that comes and goes: its own thread reads it, and reopens it when lost.

Every picture is taken as it comes, so that none waits in a queue; unwanted ones are not even
decoded. The callback runs on the thread. A read may block for seconds inside OpenCV: `close` does
not wait for it.
"""

from __future__ import annotations

import os
import re
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nodes.parts.node import TranslatedLogger
from text.i18n import N_

if TYPE_CHECKING:
    import cv2

_TIMEOUT_MS = 5000
_NO_CAMERA = N_("no such camera; plug it in, or set the parameter source (v4l2-ctl --list-devices); {others}")
_NO_DEVICE = N_("it is not a camera; v4l2-ctl --list-devices names them")
_NOT_IN_GROUP = N_("no permission; sudo usermod -aG video $USER, then log in again")
_NO_PICTURES = N_(
    "it gives no pictures: another program is using it (fuser -v {source}), or it is another device"
    " of the same camera (v4l2-ctl --list-devices)"
)
_NO_FILE = N_("no such file")
_NOT_READABLE = N_("no permission to read it (chmod +r {source})")
_NO_VIDEO = N_("OpenCV finds no video in it; is it whole?")
_NO_ANSWER = N_("nothing answers there, or it is not video")


class SourceKind(Enum):
    """The kind of a source."""

    DEVICE = "device"
    FILE = "file"
    STREAM = "stream"


@dataclass(frozen=True)
class CameraSource:
    """A source as the user names it."""

    name: str

    @property
    def kind(self) -> SourceKind:
        """Judged by the name alone."""
        if self.name.isdecimal() or self.name.startswith("/dev/"):
            return SourceKind.DEVICE
        return SourceKind.STREAM if "://" in self.name else SourceKind.FILE

    @property
    def path(self) -> Path:
        if self.name.isdecimal():
            return Path(f"/dev/video{int(self.name)}")
        return Path(self.name).expanduser()

    def __str__(self) -> str:
        """Return it for display: without the password of a URL."""
        if self.kind is SourceKind.STREAM:
            return re.sub(r"(://[^/@\s:]*):[^/@\s]*@", r"\1:***@", self.name)
        return str(self.path)

    def open(self, width: int, height: int) -> cv2.VideoCapture | None:
        """Open it, None if that fails. A device is asked for a size. May take seconds."""
        capture = self._open()
        if not capture.isOpened():
            capture.release()
            return None
        if self.kind is SourceKind.DEVICE:
            import cv2

            capture.set(cv2.CAP_PROP_FRAME_WIDTH, width)
            capture.set(cv2.CAP_PROP_FRAME_HEIGHT, height)
        return capture

    def why_not(self) -> str:
        """Return why it fails to open or to deliver, and the fix; uses `source` and `others`."""
        if self.kind is SourceKind.STREAM:
            return _NO_ANSWER
        there = self.path.exists()
        if self.kind is SourceKind.DEVICE:
            if not there:
                return _NO_CAMERA
            if not self.path.is_char_device():
                return _NO_DEVICE
            return _NO_PICTURES if os.access(self.path, os.R_OK | os.W_OK) else _NOT_IN_GROUP
        if not there:
            return _NO_FILE
        return _NO_VIDEO if os.access(self.path, os.R_OK) else _NOT_READABLE

    def _open(self) -> cv2.VideoCapture:
        import cv2

        if self.kind is SourceKind.DEVICE:
            return cv2.VideoCapture(str(self.path), cv2.CAP_V4L2)
        if self.kind is SourceKind.FILE:
            return cv2.VideoCapture(str(self.path), cv2.CAP_FFMPEG)
        patience = [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, _TIMEOUT_MS]
        patience += [cv2.CAP_PROP_READ_TIMEOUT_MSEC, _TIMEOUT_MS]
        return cv2.VideoCapture(self.name, cv2.CAP_FFMPEG, patience)


def cameras() -> list[str]:
    """Return the video devices of this machine, sorted by number."""
    found = [path for path in Path("/dev").glob("video*") if path.name[5:].isdecimal()]
    return [str(path) for path in sorted(found, key=lambda path: int(path.name[5:]))]


THREAD = "capture"
SILENT_S = 2.0
"""An open source without a picture for this long is in trouble."""
_FIRST_WAIT_S, _LONGEST_WAIT_S = 0.25, 4.0
_EARLY = 0.25
"""A picture may be early by this share of a period."""
_SAY_EVERY_S = 10.0
_MOST_FPS = 240.0

_OPEN = N_("The camera is {source}")
_LOST = N_("Lost {source}: no more pictures arrive")
_CANNOT = N_("Cannot open {source}: {problem}")
_OVER = N_("{source} is at its end")
_BROKEN = N_("Bad picture from {source}: {problem}")
_THERE = N_("there is {cameras}")
_NONE = N_("there is no camera at all (/dev/video*)")


class Capture:
    """Keeps a source open; `start` it, and `close` it at the end."""

    def __init__(
        self,
        say: TranslatedLogger,
        source: CameraSource,
        size: tuple[int, int],
        rate_hz: Callable[[], float],
        taken: Callable[[NDArray[np.uint8]], None],
        *,
        loop: bool,
    ) -> None:
        """`size` is the width and height to request; at most `rate_hz()` pictures are `taken`."""
        self._say, self.source, self._size = say, source, size
        self._rate_hz, self._taken, self._loop = rate_hz, taken, loop
        self.came = self.taken = self.connections = 0
        """Pictures that came and that were taken, and connections, since the node started."""
        self.connected = self.over = False
        self.since = ""
        """When it was connected, ISO 8601, empty if it is not."""
        self.problem = ""
        """Why it is not connected."""
        self.changed_s = self.seen_s = time.monotonic()
        """When it came or went, and when the newest picture came."""
        self._next_s = 0.0
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._live, name=THREAD, daemon=True)

    @property
    def silent(self) -> bool:
        """Whether it is open but gives no pictures."""
        return self.connected and time.monotonic() - self.seen_s > SILENT_S

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """End the thread, unless it is in a read that does not return."""
        self._ending.set()
        if self._thread.is_alive():
            self._thread.join(0.3)

    # ---------------------------------------------------------------- the thread

    def _live(self) -> None:
        _silence_opencv()
        wait_s = _FIRST_WAIT_S
        while not self._ending.is_set():
            count = self._show()
            if count and self.source.kind is SourceKind.FILE:
                if self._loop:
                    wait_s = _FIRST_WAIT_S
                    continue
                self._end()
                return
            if count:
                wait_s = _FIRST_WAIT_S
            self._ending.wait(wait_s)
            wait_s = min(2 * wait_s, _LONGEST_WAIT_S)

    def _show(self) -> int:
        """Open it and take its pictures until there are no more; return how many there were."""
        film = self._open()
        if film is None:
            return 0
        import cv2

        before = self.came
        try:
            self._read(film)
        except cv2.error as error:
            self._say.warn(_BROKEN, every_s=_SAY_EVERY_S, source=self.source, problem=error)
        finally:
            film.release()
        count = self.came - before
        if not self._ending.is_set() and not (count and self.source.kind is SourceKind.FILE):
            self._lose(count)
        return count

    def _open(self) -> cv2.VideoCapture | None:
        film = self.source.open(*self._size)
        if film is None:
            self._complain()
        return film

    def _read(self, film: cv2.VideoCapture) -> None:
        pace_s = self._pace_s(film)
        due_s = time.monotonic()
        # OpenCV knows a rate for every file that it opens; only files are paced by the clock.
        while not self._ending.is_set() and film.grab():
            self._came()
            if self._is_wanted():
                read, picture = film.retrieve()
                if read and not self._ending.is_set():
                    self.taken += 1
                    self._taken(picture)  # type: ignore[arg-type]
            if pace_s:
                due_s = max(due_s + pace_s, time.monotonic() - 1.0)
                self._ending.wait(max(0.0, due_s - time.monotonic()))

    def _pace_s(self, film: cv2.VideoCapture) -> float:
        """Return seconds between two pictures of a file, 0 for a source with its own pace."""
        import cv2

        if self.source.kind is not SourceKind.FILE:
            return 0.0
        fps = film.get(cv2.CAP_PROP_FPS)
        return 1.0 / fps if 0.0 < fps <= _MOST_FPS else 1.0 / self._rate_hz()

    def _came(self) -> None:
        self.seen_s = time.monotonic()
        self.came += 1
        if not self.connected:
            # Only a picture proves that there is a camera.
            self.connections += 1
            self.changed_s, self.connected, self.problem = self.seen_s, True, ""
            self.since = datetime.now().astimezone().isoformat(timespec="seconds")
            self._say.info(_OPEN, source=self.source)

    def _is_wanted(self) -> bool:
        period_s = 1.0 / self._rate_hz()
        now_s = time.monotonic()
        if now_s < self._next_s - _EARLY * period_s:
            return False
        self._next_s += period_s
        if self._next_s < now_s:
            self._next_s = now_s + period_s
        return True

    def _end(self) -> None:
        self._away()
        self.over, self.problem = True, self._say.text(_OVER, source=self.source)
        self._say.info(_OVER, source=self.source)

    def _lose(self, count: int) -> None:
        self._complain(_LOST if count else _CANNOT)

    def _complain(self, phrase: str = _CANNOT) -> None:
        self._away()
        there = ", ".join(cameras())
        others = self._say.text(_THERE if there else _NONE, cameras=there)
        reason = self._say.text(self.source.why_not(), source=self.source, others=others)
        self.problem = self._say.text(phrase, source=self.source, problem=reason)
        every_s = _SAY_EVERY_S if phrase is _CANNOT else 0.0
        self._say.warn(phrase, every_s=every_s, source=self.source, problem=reason)

    def _away(self) -> None:
        if self.connected:
            self.changed_s = time.monotonic()
        self.connected, self.since = False, ""


def _silence_opencv() -> None:
    """Silence OpenCV and FFmpeg, which write to stderr; what matters is logged by this node."""
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    os.environ.setdefault("OPENCV_LOG_LEVEL", "OFF")
    import cv2

    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
