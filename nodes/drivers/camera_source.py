"""Sources of pictures: a camera by number or device, a video file, or a stream by its URL."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING

from nodes.parts.parameters import Text
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


@dataclass(frozen=True)
class SourceSetting(Text):
    """A text parameter that may also be the number of a camera."""

    def accept(self, value: object) -> str:
        """Return a str; a number given without quotes becomes one."""
        if isinstance(value, int) and not isinstance(value, bool) and value >= 0:
            return str(value)
        return super().accept(value)

    def expected(self) -> str:
        return N_("number, /dev path, file or URL")
