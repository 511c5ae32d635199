"""A sound card that is not there: ALSA reads a microphone from a pipe and plays into another.

Everything between the pipes and the topics is real where ALSA is installed: alsa-lib and miniaudio.
Everywhere `alsa.c` takes the place of the first of them besides.
"""

from __future__ import annotations

import contextlib
import ctypes.util
import fcntl
import os
import select
import subprocess
import threading
from pathlib import Path

RATE_HZ = 16_000
TICK_S = 0.1
_PIECE = int(RATE_HZ * TICK_S) * 2
_CONFIGURATION = """
pcm.!default {{ type null }}
pcm.{microphone} {{
    type file
    slave.pcm {{ type null }}
    file /dev/null
    infile {folder}/said
    format raw
    hint {{ show on description "{microphone}" }}
}}
pcm.deckspeaker {{
    type file
    slave.pcm {{ type null }}
    file {folder}/played
    format raw
    hint {{ show on description "deckspeaker" }}
}}
"""


def libraries() -> list[str]:
    """The ALSA of this machine if it has one, and that of `alsa.c` in any case."""
    return ["stand-in", *(["installed"] if ctypes.util.find_library("asound") else [])]


def build_stand_in(folder: Path) -> Path:
    """Compile `alsa.c`; return the folder for LD_LIBRARY_PATH."""
    library = folder / "libasound.so.2"
    soname = f"-Wl,-soname,{library.name}"
    source = Path(__file__).with_name("alsa.c")
    flags = ("-shared", "-fPIC", "-O1", "-Wall", "-Wextra", "-Werror", soname)
    subprocess.run(["cc", *flags, "-o", library, source], check=True)
    return folder


class SoundCard:
    """Its time is the real one: the pipes are what the driver waits for."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.configuration = folder / "asound.conf"
        for name in ("said", "played"):
            os.mkfifo(folder / name)
        # Open at both ends, so that nobody waits for the other end.
        self._said = os.open(folder / "said", os.O_RDWR | os.O_NONBLOCK)
        self._played = os.open(folder / "played", os.O_RDWR | os.O_NONBLOCK)
        # Nobody shall hear later what was said while nobody listened.
        fcntl.fcntl(self._said, fcntl.F_SETPIPE_SZ, 2 * select.PIPE_BUF)
        self._sound = b""
        self.played = bytearray()
        """Whatever went to the loudspeaker, its silence included."""
        self.frozen = False
        """Whether it moves nothing, as one that hangs."""
        self._ending = threading.Event()
        self.plug("deckmic")
        self._thread = threading.Thread(target=self._live, daemon=True)
        self._thread.start()

    def plug(self, microphone: str) -> None:
        """Have a microphone of that name, and no other."""
        text = _CONFIGURATION.format(folder=self._folder, microphone=microphone)
        self.configuration.write_text(text, encoding="utf-8")

    def say(self, sound: bytes) -> None:
        """Speak into the microphone."""
        self._sound += sound

    @property
    def speaks(self) -> bool:
        """Whether there is still something to be said."""
        return bool(self._sound)

    def close(self) -> None:
        """Be gone."""
        self._ending.set()
        self._thread.join(10)
        os.close(self._said)
        os.close(self._played)

    def _live(self) -> None:
        while not self._ending.wait(TICK_S):
            if self.frozen:
                continue
            piece = self._sound[:_PIECE].ljust(_PIECE, b"\0")
            with contextlib.suppress(BlockingIOError):
                os.write(self._said, piece)
                self._sound = self._sound[_PIECE:]
            with contextlib.suppress(BlockingIOError):
                self.played += os.read(self._played, _PIECE)


def without_silence(sound: bytes | bytearray) -> bytes:
    """Samples that are not 0."""
    pairs = (bytes(sound[at : at + 2]) for at in range(0, len(sound) // 2 * 2, 2))
    return b"".join(pair for pair in pairs if pair != b"\0\0")
