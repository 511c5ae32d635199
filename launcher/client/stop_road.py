"""The road of an emergency stop that needs no middleware, and no thread of the screen.

The supervisor is asked, over a connection of its own, and writes the file that the nodes watch. One
that does not answer at once may hang: then the file is written from here, where it is the same for
all that this user runs with the same settings.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from pathlib import Path
from typing import NamedTuple

from launcher.control.socket import connect
from launcher.wire import VERSION, encode
from safety.stop_file import BY_SCREEN, StopFile
from safety.stop_record import Stop
from text.nested import read_json

ANSWERED_WITHIN_S = 0.3


class _Word(NamedTuple):
    engaged: bool
    said_ns: int


class StopRoad:
    """Gives and releases the emergency stop of one session, in the order of the calls."""

    def __init__(self, folder: Path, domain: int) -> None:
        """`folder` has the session's socket."""
        self._folder, self._domain = folder, domain
        self._lock = threading.Lock()
        self._words: deque[_Word] = deque()
        self._is_carrying = False

    def __call__(self, engaged: bool, said_ns: int) -> None:
        """Give the stop, or release those from before it: on any thread, without waiting.

        `said_ns` is when it was said, Unix time; a release may be repeated with its time.
        """
        with self._lock:
            # Of a key that is held down, the newest that waits is enough.
            if self._words and self._words[-1].engaged == engaged:
                self._words.pop()
            self._words.append(_Word(engaged, said_ns))
            if self._is_carrying:
                return
            self._is_carrying = True
        threading.Thread(target=self._carry, name="stop road", daemon=True).start()

    @property
    def is_busy(self) -> bool:
        """Whether something that was said has not been carried out yet."""
        return self._is_carrying

    def _carry(self) -> None:
        while True:
            with self._lock:
                if not self._words:
                    self._is_carrying = False
                    return
                word = self._words.popleft()
            try:
                self._ask(word)
            except Exception:  # noqa: BLE001 - whatever went wrong there, the stop goes the other way
                self._write(word)

    def _ask(self, word: _Word) -> None:
        """Ask the supervisor; raises OSError or ValueError if it has not done it."""
        operation = "emergency_stop" if word.engaged else "emergency_release"
        request = {"id": 1, "op": operation, "said_ns": word.said_ns}
        until_s = time.monotonic() + ANSWERED_WITHIN_S
        with connect(self._folder, ANSWERED_WITHIN_S) as connection:
            connection.settimeout(ANSWERED_WITHIN_S)
            connection.sendall(encode({"deck": VERSION}) + encode(request))
            with connection.makefile("rb") as lines:
                while time.monotonic() < until_s:
                    message = read_json(lines.readline())
                    if message.get("reply") == 1 and "error" not in message:
                        return
                    if "error" in message:
                        raise ValueError(message["error"])
        raise TimeoutError

    def _write(self, word: _Word) -> None:
        file = StopFile(self._domain, "/screen")
        if word.engaged:
            file.give(Stop(word.said_ns), BY_SCREEN)
        else:
            file.release(word.said_ns)
