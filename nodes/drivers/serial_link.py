"""A serial port that comes and goes: its own thread reads it, and reopens it when lost.

Only one program at a time gets a port (an advisory lock, which pyserial also respects). The
callbacks run on the reader's thread. The traffic is published on `~/frames` to subscribers.
"""

from __future__ import annotations

import contextlib
import errno
import os
import select
import termios
import threading
import time
from collections.abc import Callable
from datetime import datetime

import serial
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import String

from nodes.drivers.diagnostics import Rates, connection_status
from nodes.parts.node import LessonNode, change_period
from robot.frames.protocols import Chunk, FrameBatcher, FrameReader, RawReader, encode
from text.i18n import N_
from text.sentences import reason_of

FRAMES = "~/frames"
_LOOK_EVERY_S = 1.0
"""How often to check whether somebody is subscribed."""
_TELL_EVERY_S = 0.2
_MOST_OCTETS = 16_384
"""Bytes kept per batch: nobody could read the frames of more."""


class SerialFrames:
    """`~/frames`: the traffic in words, from the node's thread, while somebody is subscribed.

    Without subscribers, bytes are not even kept. See `robot.frames.protocols.encode` for the format.
    """

    def __init__(self, node: LessonNode, make: Callable[[str], FrameReader]) -> None:
        """`make` creates a reader of this device's frames for a language."""
        self._publisher = node.quick_publisher(String, FRAMES)
        self._batcher = FrameBatcher(make, node.say.language)
        self._wanted = False
        self._lock = threading.Lock()
        self._chunks: list[Chunk] = []
        self._octets = self._missed = 0
        self._timer = node.every(_LOOK_EVERY_S, self._look)

    def note(self, way: str, octets: bytes) -> None:
        """Note bytes that went `in` or `out`. From any thread."""
        if not self._wanted:
            return
        chunk = Chunk(time.time(), way, octets)
        with self._lock:
            if self._octets + len(octets) > _MOST_OCTETS:
                self._missed += len(octets)
                return
            self._octets += len(octets)
            self._chunks.append(chunk)

    def _look(self) -> None:
        wanted = self._publisher.get_subscription_count() > 0
        if wanted != self._wanted:
            self._wanted = wanted
            self._batcher.restart()
            self._take()
            change_period(self._timer, _TELL_EVERY_S if wanted else _LOOK_EVERY_S)
        elif wanted:
            self._tell()

    def _tell(self) -> None:
        chunks, missed = self._take()
        lines = self._batcher.tell(chunks, time.time(), missed)
        if lines:
            self._publisher.publish(String(data=encode(lines)))

    def _take(self) -> tuple[list[Chunk], int]:
        with self._lock:
            taken = self._chunks, self._missed
            self._chunks, self._octets, self._missed = [], 0, 0
        return taken


_WAIT_MS = 100
"""How long a read may wait before the thread checks whether it should end."""
_CHUNK = 4096
_STALE_S = 0.5
"""After a longer pause the waiting bytes are discarded as outdated."""


class SerialReads:
    """Reads one port from opening until closing: one wait and one read for whatever has come.

    pyserial's own `read` waits and reads once for the first byte and once more for the rest.
    """

    def __init__(self, port: serial.Serial) -> None:
        self._port, self._handle = port, port.fileno()
        self._poll = select.poll()
        self._poll.register(self._handle, select.POLLIN)
        self._read_s = time.monotonic()

    def read(self) -> bytes:
        """Return what has come, nothing after a time-out; raises OSError if the port is gone."""
        before_s, ready = self._read_s, self._poll.poll(_WAIT_MS)
        self._read_s = time.monotonic()
        if self._read_s - before_s > _STALE_S:
            self._port.reset_input_buffer()
            return b""
        if not ready:
            return b""
        try:
            data = os.read(self._handle, _CHUNK)
        except BlockingIOError:
            return b""
        if not data:
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        return data


_WITHIN_S = 0.1
"""How long a write may wait for room."""


class SerialWrites:
    """Writes to one port, and never half of something: what a full port has cut is finished first.

    pyserial's own `write` does not say how much it has sent before its time-out. What comes next would
    stick to half a line, and the device would refuse both.
    """

    def __init__(self, port: serial.Serial) -> None:
        self._port = port
        self._rest = b""
        """The end of what was begun."""

    def write(self, data: bytes) -> bool:
        """Send; return False if none of it was, since the port takes nothing.

        Of what is begun the rest is sent before anything else. Raises an error of pyserial or
        OSError if the port is gone.
        """
        deadline_s = time.monotonic() + _WITHIN_S
        self._rest = self._sent(self._rest, deadline_s)
        if self._rest:
            return False
        rest = self._sent(data, deadline_s)
        if rest == data:
            return False
        self._rest = rest
        return True

    def _sent(self, data: bytes, deadline_s: float) -> bytes:
        """Send until the deadline; return what is left of it."""
        handle = self._port.fileno()
        room = select.poll()
        room.register(handle, select.POLLOUT)
        while data and (left_s := deadline_s - time.monotonic()) > 0.0:
            if room.poll(left_s * 1e3):
                with contextlib.suppress(BlockingIOError):
                    data = data[os.write(handle, data) :]
        return data


BAD = (OSError, termios.error, serial.SerialException, TypeError)
"""Errors of pyserial when a cable is pulled; it raises TypeError if its port is closed."""
_FIRST_WAIT_S, _LONGEST_WAIT_S = 0.1, 1.0
_SAY_EVERY_S = 10.0

_OPEN = N_("Connected to {port}, {baud} baud")
_LOST = N_("Lost {port}: {problem}")
_PROBLEMS = {
    errno.ENOENT: N_("no such port; plug it in, or set the parameter port (ls /dev/serial/by-id)"),
    errno.EACCES: N_("no permission; sudo usermod -aG dialout $USER, then log in again"),
    errno.EAGAIN: N_("another program is using it; close that one (fuser -v {port})"),
    errno.ENOTTY: N_("it is not a serial port"),
}
_PROBLEMS[errno.EBUSY] = _PROBLEMS[errno.EAGAIN]
_PROBLEMS[errno.EPERM] = _PROBLEMS[errno.EACCES]
_OTHER = "{problem}"
_NOT_YET = N_("not yet connected to {port}")
_CANNOT = N_("Cannot open {port}: {problem}")
_SINCE = N_("connected to {port} for {seconds:.0f} s")


class SerialLink:
    """Keeps a port open; `start` it, and `close` it at the end."""

    def __init__(
        self,
        node: LessonNode,
        baud: int,
        heard: Callable[[bytes], None],
        opened: Callable[[], None],
        lost: Callable[[], None],
        frames: Callable[[str], FrameReader] = RawReader,
    ) -> None:
        """The port is the node's parameter `port`.

        `frames` creates a reader that puts this device's frames into words of a language.
        """
        self._say, self.port, self.baud = node.say, node.values["port"], baud
        self._heard, self._opened, self._lost = heard, opened, lost
        self.octets_in = self.octets_out = self.connections = 0
        """Since the node started."""
        self._frames = SerialFrames(node, frames)
        self._output: SerialWrites | None = None
        self._since_s, self._since = time.monotonic(), ""
        self._problem = ""
        self._writes = threading.Lock()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._live, name="serial", daemon=True)
        self._rates = Rates()

    @property
    def connected(self) -> bool:
        return self._output is not None

    def start(self) -> None:
        """Start opening and reading the port."""
        self._thread.start()

    def close(self) -> None:
        """End the thread and close the port."""
        self._ending.set()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(0.4)

    def write(self, data: bytes) -> bool:
        """Send; return False if that is not possible now. From any thread."""
        with self._writes:
            if self._output is None:
                return False
            try:
                if not self._output.write(data):
                    return False
            except BAD as error:
                # The reader notices by itself, and reopens the port.
                self._problem = reason_of(error).splitlines()[0]
                return False
            self.octets_out += len(data)
            self._frames.note("out", data)
            return True

    def status(self, name: str, errors: int, frames: int = 0) -> DiagnosticStatus:
        """Return the /diagnostics status: connection, its duration, bytes and errors per second.

        The caller counts `errors` and incoming `frames`, since the start.
        """
        seconds = time.monotonic() - self._since_s
        rates = self._rates.of(self.octets_in, self.octets_out, frames, errors)
        state = DiagnosticStatus.OK, self._say.text(_SINCE, port=self.port, seconds=seconds)
        if not self.connected:
            phrase = _CANNOT if self._problem else _NOT_YET
            state = DiagnosticStatus.ERROR, self._say.text(phrase, port=self.port, problem=self._problem)
        return connection_status(
            name,
            state,
            self.port,
            self._since,
            seconds,
            self.connections,
            bytes_in_per_s=f"{rates[0]:.0f}",
            bytes_out_per_s=f"{rates[1]:.0f}",
            frames_in_per_s=f"{rates[2]:.1f}",
            errors_per_s=f"{rates[3]:.1f}",
            errors=str(errors),
        )

    # ---------------------------------------------------------------- the reader's thread

    def _live(self) -> None:
        wait_s = _FIRST_WAIT_S
        while not self._ending.is_set():
            port = self._open()
            if port is not None:
                wait_s = _FIRST_WAIT_S
                self._read(port)
            self._ending.wait(wait_s)
            wait_s = min(2 * wait_s, _LONGEST_WAIT_S)

    def _open(self) -> serial.Serial | None:
        try:
            port = serial.Serial(self.port, self.baud, exclusive=True)
        except (*BAD, ValueError) as error:
            self._problem = self._explain(error)
            self._say.warn(_CANNOT, every_s=_SAY_EVERY_S, port=self.port, problem=self._problem)
            return None
        self.connections += 1
        self._since = datetime.now().astimezone().isoformat(timespec="seconds")
        self._since_s, self._output = time.monotonic(), SerialWrites(port)
        self._say.info(_OPEN, port=self.port, baud=self.baud)
        self._opened()
        return port

    def _read(self, port: serial.Serial) -> None:
        try:
            reads = SerialReads(port)
            while not self._ending.is_set():
                data = reads.read()
                if data:
                    self.octets_in += len(data)
                    self._frames.note("in", data)
                    self._heard(data)
                elif not _is_there(self.port):
                    raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
        except BAD as error:
            self._problem = self._explain(error)
            if not self._ending.is_set():
                self._say.warn(_LOST, port=self.port, problem=self._problem)
        finally:
            with self._writes:
                self._output, self._since_s, self._since = None, time.monotonic(), ""
                with contextlib.suppress(*BAD):
                    port.close()
            self._lost()

    def _explain(self, error: BaseException) -> str:
        cause = error.__context__ if isinstance(error.__context__, termios.error) else error
        number = cause.args[0] if cause.args and isinstance(cause.args[0], int) else None
        phrase = _PROBLEMS.get(number, _OTHER) if number is not None else _OTHER
        return self._say.text(phrase, port=self.port, problem=reason_of(error).splitlines()[0])


def _is_there(port: str) -> bool:
    """Whether a port's path still exists; one without a path (`socket://`) always does."""
    return "://" in port or os.path.lexists(port)
