"""A microphone or a loudspeaker that comes and goes: its own thread keeps it open.

miniaudio runs in a separate process (`sound_device`), restarted for each attempt. The callback
`heard` runs on the thread.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import select
import selectors
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from diagnostic_msgs.msg import DiagnosticStatus

from nodes.drivers.diagnostics import Rates, connection_status
from nodes.drivers.sound_device import CARDS, IN, OUT
from nodes.parts.node import TranslatedLogger
from robot.sound import SAMPLE
from text.i18n import N_
from text.nested import read_json

OPENED = {IN: N_("Microphone: {device}, {rate} Hz"), OUT: N_("Speaker: {device}, {rate} Hz")}
LOST = {IN: N_("Lost the microphone {device}: {problem}"), OUT: N_("Lost the speaker {device}: {problem}")}
CANNOT = {IN: N_("No microphone: {problem}"), OUT: N_("No speaker: {problem}")}
SINCE = {
    IN: N_("microphone {device}, {rate} Hz, for {seconds:.0f} s"),
    OUT: N_("speaker {device}, {rate} Hz, for {seconds:.0f} s"),
}
OFF = N_("off, by the parameter")
FAULTY = N_("{words}; {faults:.0f} errors a second")
OPENING = N_("it is being opened")

EMPTY = N_("An empty message for the speaker")
ODD = N_("{count} bytes for the speaker, but a sample has two: the last is left out")
WORDS = N_('The speaker got text instead of sound: "{words}"')
LATE = N_("The speaker is late: the oldest {seconds:.1f} s of sound are dropped")
UNPLAYED = N_("There is no speaker now: {seconds:.1f} s of sound are not played")

_PROBLEMS = {
    "package": N_("miniaudio is not installed; pip install miniaudio"),
    "library": N_("neither PulseAudio nor ALSA is installed; sudo apt install libasound2"),
    "missing": N_('no device "{device}"; set the parameter to one of these: {detail}'),
    "none": N_(
        "no such sound device; plug it in (arecord -l and aplay -l list them), "
        "or sudo usermod -aG audio $USER and log in again"
    ),
    "busy": N_("it cannot be opened; close the program that uses it (fuser -v /dev/snd/*)"),
    "gone": N_("it is gone; is it unplugged?"),
    "silent": N_("no sound moves any more"),
    "hung": N_("the library of sound does not answer"),
    "died": N_("the library of sound has died: {detail}"),
    "other": N_("{detail}"),
}


def explain(say: TranslatedLogger, problem: str, device: str, detail: str) -> str:
    """Return what is wrong with a device, and the fix."""
    if problem == "missing" and not (device and detail):
        problem = "none"
    return say.text(_PROBLEMS.get(problem, _PROBLEMS["other"]), device=device, detail=detail)


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


NOWHERE = "none"
"""The device name that means no device."""
_FIRST_WAIT_S, _LONGEST_WAIT_S = 0.25, 15.0
_LOOK_S = 0.25
_OPEN_S = 15.0
"""Time limit: a sound server may have to start first."""
_ANSWER_S = 5.0
"""It reports once a second; after this long without a report, it hangs."""
_PATIENCE_S = 3.0
"""How long sound waits for a loudspeaker that is being opened."""
_SAY_EVERY_S = 10.0


class SoundPort:
    """One direction; `start` it, and `close` it at the end."""

    def __init__(
        self,
        say: TranslatedLogger,
        way: str,
        device: str,
        rate_hz: int,
        block_ms: int,
        *,
        heard: Callable[[bytes], None] | None = None,
        queue_s: float = 0.0,
    ) -> None:
        """`heard` gets the microphone's blocks; `queue_s` of sound may wait for a loudspeaker."""
        self._say, self.way, self.wanted = say, way, device
        self.rate_hz, self._block_ms = rate_hz, block_ms
        self._heard = heard
        self._block = rate_hz * block_ms // 1000 * SAMPLE
        self._queue, self._most = bytearray(), round(rate_hz * queue_s) * SAMPLE
        """What waits for the loudspeaker, and how much of it may; the oldest is dropped."""
        self._queueing = threading.Lock()
        self.octets = self.faults = self.connections = 0
        """Bytes moved, blocks missed and connections, since the start."""
        self.device, self.problem = "", say.text(OPENING)
        self.connected, self.since_s, self.since = False, time.monotonic(), ""
        """Start of the current state; while connected also as ISO 8601."""
        self._rates = Rates()
        self._missed = 0
        self._part = b""
        """Half a sample left over from a read block, or from sound to write."""
        self._ending = threading.Event()
        self._stirred = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        self._thread = threading.Thread(target=self._live, name=f"sound {way}", daemon=True)

    @property
    def wants(self) -> bool:
        return self.wanted.casefold() != NOWHERE

    def start(self) -> None:
        if self.wants:
            self._thread.start()

    def close(self) -> None:
        """End the thread and the process."""
        self._ending.set()
        os.eventfd_write(self._stirred, 1)
        if self._thread.is_alive():
            self._thread.join(0.4)

    def play(self, sound: bytes) -> tuple[int, bool]:
        """Queue whole samples; return (bytes dropped, whether there is a loudspeaker)."""
        if not self.connected and time.monotonic() - self.since_s > _PATIENCE_S:
            return len(sound), False
        with self._queueing:
            self._queue += sound
            dropped = max(0, len(self._queue) - self._most)
            del self._queue[:dropped]
        self.faults += bool(dropped)
        os.eventfd_write(self._stirred, 1)
        return dropped, True

    def status(self, name: str) -> DiagnosticStatus:
        """Return the /diagnostics status: the device, time connected, bytes and errors per second."""
        seconds, port = time.monotonic() - self.since_s, self.device or self.wanted
        octets, faults = self._rates.of(self.octets, self.faults)
        return connection_status(
            name,
            self._state(seconds, faults),
            port,
            self.since,
            seconds,
            self.connections,
            bytes_in_per_s=f"{octets if self.way == IN else 0:.0f}",
            bytes_out_per_s=f"{0 if self.way == IN else octets:.0f}",
            errors_per_s=f"{faults:.1f}",
            errors=str(self.faults),
            sample_rate=str(self.rate_hz),
        )

    def _state(self, seconds: float, faults: float) -> tuple[bytes, str]:
        say = self._say
        if not self.wants:
            return DiagnosticStatus.OK, say.text(OFF)
        if not self.connected:
            return DiagnosticStatus.ERROR, say.text(CANNOT[self.way], problem=self.problem)
        words = say.text(SINCE[self.way], device=self.device, rate=self.rate_hz, seconds=seconds)
        if faults:
            return DiagnosticStatus.WARN, say.text(FAULTY, words=words, faults=faults)
        return DiagnosticStatus.OK, words

    # ---------------------------------------------------------------- the thread

    def _live(self) -> None:
        wait_s = _FIRST_WAIT_S
        while not self._ending.is_set():
            connections, cards = self.connections, _cards()
            problem, detail = self._serve()
            if self._ending.is_set():
                return
            lost = self.connections > connections
            self._tell(problem, detail, lost=lost)
            wait_s = _FIRST_WAIT_S if lost else wait_s
            self._rest(wait_s, cards)
            wait_s = min(2 * wait_s, _LONGEST_WAIT_S)

    def _rest(self, wait_s: float, cards: bytes) -> None:
        """Wait for the next attempt; no longer than until the sound cards change."""
        until_s = time.monotonic() + wait_s
        while time.monotonic() < until_s and _cards() == cards:
            if self._ending.wait(min(_LOOK_S, wait_s)):
                return

    def _tell(self, problem: str, detail: str, *, lost: bool) -> None:
        self.problem = explain(self._say, problem, self.wanted, detail)
        if lost:
            self._say.warn(LOST[self.way], device=self.device, problem=self.problem)
        else:
            self._say.warn(CANNOT[self.way], every_s=_SAY_EVERY_S, problem=self.problem)

    def _serve(self) -> tuple[str, str]:
        """Open the device, and move sound until that fails; return (problem, detail)."""
        try:
            child = SoundChild(self.way, self.wanted, self.rate_hz, self._block_ms)
        except OSError as error:
            return "other", str(error)
        try:
            problem, detail = self._move(child)
        except OSError:
            # Its sound ends before its messages do.
            child.await_end()
            problem, detail = self._hear_words(child) or ("died", "")
        finally:
            if self.connected:
                self.connected, self.since_s, self.since = False, time.monotonic(), ""
            with self._queueing:
                self._queue.clear()
            child.close()
        return problem, detail or child.last_words

    def _move(self, child: SoundChild) -> tuple[str, str]:
        self._part, answered_s, patience_s = b"", time.monotonic(), _OPEN_S
        with selectors.DefaultSelector() as selector:
            for descriptor in (child.words, self._stirred):
                selector.register(descriptor, selectors.EVENT_READ)
            sound = selectors.EVENT_READ if self.way == IN else 0
            while not self._ending.is_set():
                if self.way == OUT:
                    sound = selectors.EVENT_WRITE if self._has_sound() else 0
                _watch(selector, child.sound, sound)
                ready = {key.fd for key, _events in selector.select(_LOOK_S)}
                if self._stirred in ready:
                    os.eventfd_read(self._stirred)
                if child.sound in ready:
                    self._carry(child)
                if child.words in ready:
                    answered_s, patience_s = time.monotonic(), _ANSWER_S
                    end = self._hear_words(child)
                    if end is not None:
                        return end
                if time.monotonic() - answered_s > patience_s:
                    return "hung", ""
        return "", ""

    def _hear_words(self, child: SoundChild) -> tuple[str, str] | None:
        """Take the messages of the process; return (problem, detail) if it has ended."""
        told = child.messages()
        if told is None:
            child.await_end()
            return "died", ""
        for message in told:
            if "problem" in message:
                return str(message["problem"]), str(message.get("detail", ""))
            if "opened" in message:
                self._open(str(message["opened"]))
            self._missed, before = int(str(message.get("faults", 0))), self._missed
            self.faults += max(0, self._missed - before)
        return None

    def _open(self, device: str) -> None:
        self.device = device
        self._missed = 0
        self.connections += 1
        self.since = datetime.now().astimezone().isoformat(timespec="seconds")
        self.connected, self.since_s = True, time.monotonic()
        self._say.info(OPENED[self.way], device=device, rate=self.rate_hz)

    def _has_sound(self) -> bool:
        return self.connected and bool(self._part or self._queue)

    def _carry(self, child: SoundChild) -> None:
        if self.way == OUT:
            if not self._part:
                with self._queueing:
                    self._part = bytes(self._queue[: self._block])
                    del self._queue[: self._block]
            left = child.play(self._part)
            self.octets += len(self._part) - len(left)
            self._part = left
            return
        data = child.hear()
        self.octets += len(data)
        self._part += data
        while len(self._part) >= self._block:
            block, self._part = self._part[: self._block], self._part[self._block :]
            if self._heard is not None:
                self._heard(block)


def _watch(selector: selectors.BaseSelector, descriptor: int, events: int) -> None:
    """Watch a descriptor for these events; 0 for none."""
    watched = descriptor in selector.get_map()
    if watched and events != selector.get_key(descriptor).events:
        selector.unregister(descriptor)
        watched = False
    if events and not watched:
        selector.register(descriptor, events)


def _cards() -> bytes:
    try:
        return CARDS.read_bytes()
    except OSError:
        return b""
