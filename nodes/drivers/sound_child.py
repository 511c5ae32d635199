"""The process that runs miniaudio, as seen by the node."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import select
import subprocess
import sys
import threading
from pathlib import Path

from nodes.drivers.sound_device import IN, OUT
from text.nested import read_json

PROGRAM = Path(__file__).with_name("sound_device.py")
_CHUNK = 65_536
_LONGEST_LINE = 4096
_LAST_WAIT_S = 0.2


class SoundChild:
    """Runs from its creation until `close`; raises OSError if it cannot be started."""

    def __init__(self, way: str, device: str, rate_hz: int, block_ms: int) -> None:
        # It dies with the thread that created it, which must be the one that serves it.
        self._process = subprocess.Popen(
            [sys.executable, str(PROGRAM), way, device, str(rate_hz), str(block_ms)],
            bufsize=0,
            stdin=subprocess.PIPE if way == OUT else subprocess.DEVNULL,
            stdout=subprocess.PIPE if way == IN else subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )
        pipe = self._process.stdin if way == OUT else self._process.stdout
        assert pipe is not None
        assert self._process.stderr is not None
        self.sound, self.words = pipe.fileno(), self._process.stderr.fileno()
        """Non-blocking file descriptors."""
        if way == OUT:
            # What is in the pipe can no longer be dropped.
            fcntl.fcntl(self.sound, fcntl.F_SETPIPE_SZ, select.PIPE_BUF)
        os.set_blocking(self.sound, False)
        os.set_blocking(self.words, False)
        self._line = b""
        self.last_words = ""
        """The last line that is not a message: a library's output before it died."""

    def hear(self) -> bytes:
        """Return sound from the microphone; raises OSError at its end."""
        with contextlib.suppress(BlockingIOError):
            data = os.read(self.sound, _CHUNK)
            if not data:
                raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))
            return data
        return b""

    def play(self, sound: bytes) -> bytes:
        """Send sound to the loudspeaker; return what did not fit. Raises OSError at its end."""
        with contextlib.suppress(BlockingIOError):
            return sound[os.write(self.sound, sound) :]
        return sound

    def messages(self) -> list[dict[str, object]] | None:
        """Return the messages since the last call, None when there will be no more."""
        try:
            data = os.read(self.words, _CHUNK)
        except BlockingIOError:
            return []
        if not data:
            return None
        *lines, rest = (self._line + data).split(b"\n")
        self._line = rest[-_LONGEST_LINE:]
        return [told for line in lines if (told := self._message(line)) is not None]

    def _message(self, line: bytes) -> dict[str, object] | None:
        with contextlib.suppress(ValueError):
            told = read_json(line)
            if isinstance(told, dict):
                return told
        self.last_words = line[:_LONGEST_LINE].decode("utf-8", "replace").strip()
        return None

    def await_end(self) -> None:
        """Wait a moment for a process that has closed its pipes."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(_LAST_WAIT_S)

    def close(self) -> None:
        """Kill the process if need be."""
        self._process.kill()
        self.await_end()
        if self._process.returncode is None:
            # A hanging device delays even a killed process, which is collected later.
            threading.Thread(target=self._process.wait, daemon=True).start()
        if not self.last_words and self._process.returncode:
            self.last_words = f"exit code {self._process.returncode}"
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            if pipe is not None:
                pipe.close()
