"""A microphone or a loudspeaker in its own process: `portaudio.py in|out DEVICE HZ MS`.

PortAudio lists the devices only once, at its start; when one is unplugged it has been seen to hang,
to spin and to abort, and it writes to stderr. So it runs here, where it can be killed and restarted
without harm to the node. Neither the project nor numpy is imported.

16-bit mono samples come out of stdout or go into stdin. Stderr carries reports as lines of JSON:
{"opened": NAME, "rate": HZ}, then {"faults": N} once a second, and at the end possibly
{"problem": WORD, "detail": TEXT}. Other lines there come from the libraries.
"""

from __future__ import annotations

import ctypes
import json
import os
import select
import signal
import sys
import threading
import time
from collections import deque
from typing import TYPE_CHECKING, NoReturn, Protocol

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from types import ModuleType

IN, OUT = "in", "out"
SAMPLE = 2
KEPT_BLOCKS = 20
"""Buffer for the microphone, while the node does not read it."""
AHEAD_BLOCKS = 2
"""Buffer for the loudspeaker; the node holds the rest, where it can be dropped."""
SILENT_S = 2.0
"""A device without any data for this long is gone, whatever it reports."""
_TICK_S = 0.05
_TELL_S = 1.0
_INVALID_RATE = -9997
_BUSY = -9985
_PR_SET_PDEATHSIG = 1


class Flags(Protocol):
    """sounddevice's error flags for a block."""

    input_overflow: bool
    output_underflow: bool


class Stream(Protocol):
    """An open sounddevice stream."""

    active: bool
    samplerate: float

    def start(self) -> None:
        """Begin."""


def choose(
    devices: Sequence[Mapping[str, object]], wanted: str, way: str, default: int
) -> int | None:
    """Return the index of the wanted device, None if there is none.

    `wanted` is an index, a name, part of a name, or empty for the default or else the first.
    """
    fit = [at for at, device in enumerate(devices) if device[f"max_{way}put_channels"] != 0]
    if not wanted:
        return default if default in fit else next(iter(fit), None)
    if wanted.isdecimal():
        return int(wanted) if int(wanted) in fit else None
    names = {at: str(devices[at]["name"]).casefold() for at in fit}
    asked = wanted.casefold()
    same = [at for at, name in names.items() if name == asked]
    return next(iter(same or [at for at, name in names.items() if asked in name]), None)


class AudioPipe:
    """Moves the bytes between PortAudio's thread and a pipe."""

    def __init__(self) -> None:
        self.faults = 0
        """Overflows and underflows, and blocks that were dropped."""
        self.stirred_s = time.monotonic()
        self._blocks: deque[bytes] = deque(maxlen=KEPT_BLOCKS)
        self._part = b""
        self._moved = threading.Event()

    # On PortAudio's thread, which must not wait for anything.

    def hear(self, data: memoryview, _frames: int, _time: object, status: Flags) -> None:
        """Take a block from the microphone."""
        self.faults += bool(status.input_overflow) + (len(self._blocks) == KEPT_BLOCKS)
        self._blocks.append(bytes(data))
        self._stir()

    def play(self, data: memoryview, _frames: int, _time: object, status: Flags) -> None:
        """Fill a block for the loudspeaker, with silence if nothing waits."""
        self.faults += bool(status.output_underflow)
        want = len(data)
        while len(self._part) < want and self._blocks:
            self._part += self._blocks.popleft()
        # Half a sample waits for its other half.
        ready = min(want, len(self._part) // SAMPLE * SAMPLE)
        data[:] = self._part[:ready].ljust(want, b"\0")
        self._part = self._part[ready:]
        self._stir()

    def _stir(self) -> None:
        self.stirred_s = time.monotonic()
        self._moved.set()

    # On the main thread.

    def give(self) -> None:
        """Write out the microphone's sound."""
        self._moved.wait(_TICK_S)
        self._moved.clear()
        while self._blocks:
            block = self._blocks.popleft()
            while block:
                block = block[os.write(1, block) :]

    def take(self, most: int) -> None:
        """Read what to play, while little is waiting."""
        if len(self._blocks) >= AHEAD_BLOCKS:
            self._moved.wait(_TICK_S)
            self._moved.clear()
        elif select.select([0], [], [], _TICK_S)[0]:
            data = os.read(0, most)
            if not data:
                os._exit(0)
            self._blocks.append(data)


def tell(**words: object) -> None:
    """Write a line of JSON to stderr, in one piece."""
    os.write(2, json.dumps(words).encode() + b"\n")


def end(problem: str, detail: object = "") -> NoReturn:
    """Report why, and exit; PortAudio must not clean up, as that is where it hangs."""
    tell(problem=problem, detail=" ".join(str(detail).split()))
    os._exit(1)


def load() -> ModuleType:
    """Import sounddevice, which starts PortAudio."""
    # Kernel devices through ALSA's converter of rates, channels and formats.
    os.environ.setdefault("PA_ALSA_PLUGHW", "1")
    try:
        import sounddevice
    except ImportError as error:
        end("package", error)
    except OSError as error:
        end("library", error)
    except Exception as error:  # noqa: BLE001 - its own error type comes with the import
        end("other", error)
    module: ModuleType = sounddevice
    return module


def open_stream(
    sound: ModuleType, way: str, wanted: str, rate_hz: int, block_ms: int, line: AudioPipe
) -> Stream:
    """Open and start the device, at its own rate if it does not support the requested one."""
    devices = sound.query_devices()
    at = choose(devices, wanted, way, sound.default.device[way == OUT])
    if at is None:
        fit = [one["name"] for one in devices if one[f"max_{way}put_channels"] > 0]
        end("missing", ", ".join(fit))
    make = sound.RawInputStream if way == IN else sound.RawOutputStream
    for hz in (rate_hz, int(devices[at]["default_samplerate"])):
        try:
            stream: Stream = make(
                samplerate=hz,
                blocksize=hz * block_ms // 1000,
                device=at,
                channels=1,
                dtype="int16",
                callback=line.hear if way == IN else line.play,
            )
            stream.start()
        except sound.PortAudioError as error:
            code = error.args[1] if len(error.args) > 1 else None
            if code == _INVALID_RATE and hz == rate_hz:
                continue
            end("busy" if code == _BUSY else "other", error)
        tell(opened=devices[at]["name"], rate=hz)
        return stream
    end("rate", rate_hz)


def run(way: str, wanted: str, rate_hz: int, block_ms: int) -> NoReturn:
    """Move sound until the node or the device is gone."""
    line = AudioPipe()
    stream = open_stream(load(), way, wanted, rate_hz, block_ms, line)
    most = int(stream.samplerate) * block_ms // 1000 * SAMPLE
    told_s = line.stirred_s = time.monotonic()
    while True:
        if way == IN:
            line.give()
        else:
            line.take(most)
        now_s = time.monotonic()
        if not stream.active:
            end("gone")
        if now_s - line.stirred_s > SILENT_S + block_ms / 1000:
            end("silent")
        if now_s - told_s >= _TELL_S:
            told_s = now_s
            tell(faults=line.faults)


def main(words: Sequence[str]) -> NoReturn:
    """Run, and end when the node ends, however it ends."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, ctypes.c_ulong(signal.SIGKILL), 0, 0, 0)
    way, wanted, rate_hz, block_ms = words
    try:
        run(way, wanted, int(rate_hz), int(block_ms))
    except OSError:
        # The other end of the pipe is closed.
        os._exit(0)


if __name__ == "__main__":
    # The nodes beside this file must not be importable as libraries.
    del sys.path[0]
    main(sys.argv[1:])
