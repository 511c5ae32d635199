"""A microphone or a loudspeaker in its own process: `sound_device.py in|out DEVICE HZ MS`.

`sound_device.py list` prints the names instead, as JSON: [[MICROPHONE, ...], [SPEAKER, ...]].

Libraries of sound have been seen to hang, to spin and to abort when a device is unplugged, and they
write to stderr. So miniaudio runs here, where it can be killed and restarted without harm to the
node. Nothing of the project is imported. miniaudio loads PulseAudio or ALSA when it runs, and
converts rates, channels and formats itself.

16-bit mono samples come out of stdout or go into stdin. Stderr carries reports as lines of JSON:
{"opened": NAME}, then {"faults": N} once a second, and at the end possibly
{"problem": WORD, "detail": TEXT}. Other lines there come from the libraries.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import select
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Generator, Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, NoReturn

IN, OUT = "in", "out"
SAMPLE = 2
NULL = "null"
"""The device of a machine without a card: silence in, nothing out, at the pace of a real one."""
CARDS = Path("/proc/asound/cards")
KEPT_BLOCKS = 20
"""Buffer for the microphone, while the node does not read it."""
AHEAD_BLOCKS = 2
"""Buffer for the loudspeaker; the node holds the rest, where it can be dropped."""
SILENT_S = 2.0
"""A device without any data for this long is gone, whatever it reports."""
_TICK_S = 0.05
_TELL_S = 1.0
_PR_SET_PDEATHSIG = 1


def choose(names: Sequence[str], wanted: str) -> int | None:
    """Return the index of the wanted device, None if there is none.

    `wanted` is an index, a name, or part of a name.
    """
    if wanted.isdecimal():
        return int(wanted) if int(wanted) < len(names) else None
    asked = wanted.casefold()
    folded = [name.casefold() for name in names]
    same = [at for at, name in enumerate(folded) if name == asked]
    return next(iter(same or [at for at, name in enumerate(folded) if asked in name]), None)


class AudioPipe:
    """Moves the bytes between miniaudio's thread and a pipe."""

    def __init__(self) -> None:
        self.faults = 0
        """Blocks of the microphone that were dropped."""
        self.stirred_s = time.monotonic()
        self._blocks: deque[bytes] = deque(maxlen=KEPT_BLOCKS)
        self._part = b""
        self._moved = threading.Event()

    # On miniaudio's thread, which must not wait for anything.

    def hearing(self) -> Generator[None, bytes, None]:
        """Take blocks from the microphone."""
        while True:
            block = yield
            self.faults += len(self._blocks) == KEPT_BLOCKS
            self._blocks.append(bytes(block))
            self._stir()

    def playing(self) -> Generator[bytes, int, None]:
        """Give blocks of so many samples for the loudspeaker, of silence if nothing waits."""
        samples = yield b""
        while True:
            samples = yield self._next(samples * SAMPLE)

    def _next(self, want: int) -> bytes:
        while len(self._part) < want and self._blocks:
            self._part += self._blocks.popleft()
        # Half a sample waits for its other half.
        ready = min(want, len(self._part) // SAMPLE * SAMPLE)
        block = self._part[:ready].ljust(want, b"\0")
        self._part = self._part[ready:]
        self._stir()
        return block

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
    """Report why, and exit; the libraries must not clean up, as that is where it hangs."""
    tell(problem=problem, detail=" ".join(str(detail).split()))
    os._exit(1)


def load() -> ModuleType:
    """Return miniaudio, which is imported late; raise what the user can do where it does not load."""
    try:
        import miniaudio
    except (ImportError, OSError) as error:
        end("package", error)
    module: ModuleType = miniaudio
    return module


def names(sound: ModuleType, backend: object, way: str) -> tuple[list[str], list[object]]:
    """Return names and ids of the devices in this direction; raises MiniaudioError."""

    class Devices(sound.Devices):  # type: ignore[misc, name-defined]
        """Without the formats, for which every device is opened: a busy one would fail them all."""

        def _get_info(self, *_of: object) -> dict[str, object]:
            return {}

    known = Devices([backend])
    devices = known.get_captures() if way == IN else known.get_playbacks()
    if backend == sound.Backend.ALSA:
        # ALSA lists a device that is none.
        devices = [one for one in devices if sound.ffi.buffer(one["id"])[:5] != b"null\0"]
    return [device["name"] for device in devices], [device["id"] for device in devices]


def listed(sound: ModuleType, way: str) -> Iterator[tuple[Any, Sequence[str], Sequence[object]]]:
    """Yield names and ids of the devices by library of the system, the preferred one first."""
    for backend in (sound.Backend.PULSEAUDIO, sound.Backend.ALSA):
        with contextlib.suppress(sound.MiniaudioError):
            yield backend, *names(sound, backend, way)


def find(sound: ModuleType, way: str, wanted: str) -> tuple[object, object, str]:
    """Return (backend, id, name) of the wanted device; the default one has no id."""
    if wanted.casefold() == NULL:
        return sound.Backend.NULL, None, NULL
    there: list[str] = []
    answered = False
    for backend, found, ids in listed(sound, way):
        answered = True
        there += found
        at = choose(found, wanted)
        if not wanted and found:
            return backend, None, f"default ({backend.name})"
        if at is not None:
            return backend, ids[at], found[at]
    end("missing" if answered else "library", ", ".join(dict.fromkeys(there)))


def open_device(sound: ModuleType, way: str, wanted: str, rate_hz: int, block_ms: int, line: AudioPipe) -> Any:  # noqa: ANN401 - of miniaudio
    """Open and start the device."""
    backend, device_id, name = find(sound, way, wanted)
    make = sound.CaptureDevice if way == IN else sound.PlaybackDevice
    moving: Generator[object, object, None] = line.hearing() if way == IN else line.playing()  # type: ignore[assignment]
    next(moving)
    try:
        device = make(
            sound.SampleFormat.SIGNED16,
            nchannels=1,
            sample_rate=rate_hz,
            buffersize_msec=block_ms,
            device_id=device_id,
            backends=[backend],
        )
        # Only with one does it note that it has stopped.
        device.stop_callback = lambda: None
        device.start(moving)
    except sound.MiniaudioError:
        end("busy" if wanted or has_card() else "missing")
    tell(opened=name)
    return device


def has_card() -> bool:
    """Whether the kernel knows a sound card."""
    try:
        return b"[" in CARDS.read_bytes()
    except OSError:
        return False


def run(way: str, wanted: str, rate_hz: int, block_ms: int) -> NoReturn:
    """Move sound until the node or the device is gone."""
    line = AudioPipe()
    device = open_device(load(), way, wanted, rate_hz, block_ms, line)
    most = rate_hz * block_ms // 1000 * SAMPLE
    told_s = line.stirred_s = time.monotonic()
    while True:
        if way == IN:
            line.give()
        else:
            line.take(most)
        now_s = time.monotonic()
        if not device.running:
            end("gone")
        if now_s - line.stirred_s > SILENT_S + block_ms / 1000:
            end("silent")
        if now_s - told_s >= _TELL_S:
            told_s = now_s
            tell(faults=line.faults)


def show_names(sound: ModuleType) -> NoReturn:
    """Print the names of all devices, and exit."""
    there = [[name for _, found, _ in listed(sound, way) for name in found] for way in (IN, OUT)]
    os.write(1, json.dumps(there).encode() + b"\n")
    os._exit(0)


def main(words: Sequence[str]) -> NoReturn:
    """Run, and end when the node ends, however it ends."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    if list(words) == ["list"]:
        show_names(load())
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
