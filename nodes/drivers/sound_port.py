"""A microphone or a loudspeaker that comes and goes: its own thread keeps it open.

miniaudio runs in a separate process (`sound_device`), restarted for each attempt. The callback
`heard` runs on the thread.
"""

from __future__ import annotations

import os
import selectors
import threading
import time
from datetime import datetime
from typing import TYPE_CHECKING

from nodes.drivers.sound_child import SoundChild
from nodes.drivers.sound_device import CARDS, IN, OUT
from nodes.drivers.sound_queue import SoundQueue
from nodes.drivers.sound_words import CANNOT, LOST, OPENED, OPENING, explain
from robot.sound import SAMPLE

if TYPE_CHECKING:
    from collections.abc import Callable

    from nodes.parts.translated_logger import TranslatedLogger

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
        self._queue = SoundQueue(round(rate_hz * queue_s) * SAMPLE)
        self.octets = self.faults = self.connections = 0
        """Bytes moved, blocks missed and connections, since the start."""
        self.device, self.problem = "", say.text(OPENING)
        self.connected, self.since_s, self.since = False, time.monotonic(), ""
        """Start of the current state; while connected also as ISO 8601."""
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
        dropped = self._queue.put(sound)
        self.faults += bool(dropped)
        os.eventfd_write(self._stirred, 1)
        return dropped, True

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
        return self.connected and bool(self._part or len(self._queue))

    def _carry(self, child: SoundChild) -> None:
        if self.way == OUT:
            self._part = self._part or self._queue.take(self._block)
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
