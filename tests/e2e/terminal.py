"""A real terminal for `deck`: a pseudo-terminal at one end, a screen to look at on the other.

Used by the end-to-end tests, by the benchmarks, and by the script that makes the README's picture.
"""

from __future__ import annotations

import codecs
import fcntl
import io
import os
import pty
import select
import signal
import struct
import subprocess
import termios
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pyte
from rich.console import Console
from rich.style import Style
from rich.text import Text

from tests.slowness import patient
from tests.waiting import DEADLINE_S, wait_until

KEYS = {
    "enter": "\r",
    "escape": "\x1b",
    "tab": "\t",
    "space": " ",
    "up": "\x1b[A",
    "down": "\x1b[B",
    "right": "\x1b[C",
    "left": "\x1b[D",
    "home": "\x1b[H",
    "end": "\x1b[F",
    "f1": "\x1bOP",
    "f2": "\x1bOQ",
    "f3": "\x1bOR",
    "f4": "\x1bOS",
    "f5": "\x1b[15~",
    "f8": "\x1b[19~",
    "shift+f4": "\x1b[1;2S",
    "shift+f5": "\x1b[15;2~",
    "shift+f9": "\x1b[20;2~",
}
"""What a terminal sends for the keys that have names; `ctrl+x` and `alt+v` are understood
besides."""


KEPT = 4_000_000
PACKET = 1024


class Terminal:
    """One program in a terminal of its own, its output read all the time.

    Attributes:
        received: bytes that the program has written to the terminal so far.
        kept: those bytes, as many as come before the first `KEPT`.
        bytes_per_s: how fast the line to it is; 0 for any speed.
    """

    def __init__(
        self,
        argv: Sequence[str],
        columns: int = 120,
        rows: int = 40,
        env: Mapping[str, str] | None = None,
        cwd: str | None = None,
    ) -> None:
        self.received = 0
        self.kept = bytearray()
        self.bytes_per_s = 0
        self._lock = threading.Lock()
        self._hung_up = threading.Event()
        self._screen = pyte.Screen(columns, rows)
        self._seen = (-1, 0, 0)
        self._text = ""
        self._stream = pyte.Stream(self._screen)
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._master, slave = pty.openpty()
        self._set_size(columns, rows)
        self.process = subprocess.Popen(
            list(argv),
            stdin=slave,
            stdout=slave,
            stderr=slave,
            cwd=cwd,
            env={**os.environ, "TERM": "xterm-256color", "COLORTERM": "truecolor", **(env or {})},
            start_new_session=True,
            preexec_fn=_take_terminal,  # noqa: PLW1509 - one system call, no Python lock
        )
        os.close(slave)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def press(self, *keys: str) -> None:
        """Press keys by name (`enter`, `ctrl+x`, `alt+v`, `a`)."""
        for key in keys:
            if key.startswith("ctrl+"):
                self.type(chr(ord(key[-1]) & 0x1F))
            elif key.startswith("alt+"):
                self.type(f"\x1b{key[-1]}")
            else:
                self.type(key if len(key) == 1 else KEYS[key])

    def type(self, text: str) -> None:
        os.write(self._master, text.encode())

    def resize(self, columns: int, rows: int) -> None:
        """Change the size of the window; the program gets SIGWINCH."""
        with self._lock:
            self._screen.resize(rows, columns)
        self._set_size(columns, rows)

    def hang_up(self) -> None:
        """Close the window: the program gets SIGHUP, and every read and write fails."""
        if not self._hung_up.is_set():
            self._hung_up.set()
            self._reader.join()
            os.close(self._master)

    def text(self) -> str:
        """What stands on the screen now, a line a row."""
        with self._lock:
            # Waiting looks far oftener than anything changes.
            seen = (self.received, self._screen.lines, self._screen.columns)
            if seen != self._seen:
                self._seen, self._text = seen, "\n".join(self._screen.display)
            return self._text

    def ground(self, column: int, row: int) -> str:
        """The background of a cell as six hexadecimal digits, or its name."""
        with self._lock:
            return str(self._screen.buffer[row][column].bg)

    def wait_for(self, text: str, within_s: float = DEADLINE_S) -> str:
        """Wait until `text` stands on the screen; return the screen."""
        return self.wait_until(lambda screen: text in screen, f"{text!r} on screen", within_s)

    def wait_for_line(self, line: str, within_s: float = DEADLINE_S) -> str:
        """Wait until `line` has been printed, in however many rows; return all rows as one line.

        For what is printed without a screen of its own: where the terminal breaks a line that has a
        path in it depends on where the temporary folder is.
        """

        def printed() -> str | None:
            unbroken = self.text().replace("\n", "")
            return unbroken if line in unbroken else None

        return wait_until(printed, lambda: f"{line!r}; the screen:\n{self.text()}", within_s)

    def wait_gone(self, text: str, within_s: float = DEADLINE_S) -> str:
        """Wait until `text` does not stand on the screen any more; return the screen."""
        return self.wait_until(lambda screen: text not in screen, f"no {text!r}", within_s)

    def wait_until(self, condition: Callable[[str], bool], what: str, within_s: float = DEADLINE_S) -> str:
        """Wait until `condition` holds of the screen's text; return that text."""

        def shown() -> str | None:
            screen = self.text()
            return screen if condition(screen) else None

        return wait_until(shown, lambda: f"{what}; the screen:\n{self.text()}", within_s)

    def wait_exit(self, within_s: float = DEADLINE_S) -> int:
        """Wait until the program has ended; return its exit code."""
        return self.process.wait(timeout=within_s)

    def svg(self, title: str = "deck") -> str:
        with self._lock:
            console = Console(
                record=True,
                width=self._screen.columns,
                height=self._screen.lines,
                file=io.StringIO(),
                force_terminal=True,
                color_system="truecolor",
                legacy_windows=False,
            )
            for row in range(self._screen.lines):
                console.print(self._row(row), end="\n", no_wrap=True, overflow="crop")
        return console.export_svg(title=title)

    def close(self) -> None:
        """End the program: asked first, then made to."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self.process.wait(timeout=patient(15))
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.hang_up()

    def _row(self, row: int) -> Text:
        text = Text()
        cells = self._screen.buffer[row]
        for column in range(self._screen.columns):
            cell = cells[column]
            if not cell.data:  # the right half of a wide character
                continue
            text.append(
                cell.data,
                Style(
                    color=_colour(cell.fg),
                    bgcolor=_colour(cell.bg),
                    bold=cell.bold,
                    italic=cell.italics,
                    underline=cell.underscore,
                    reverse=cell.reverse,
                ),
            )
        return text

    def _set_size(self, columns: int, rows: int) -> None:
        fcntl.ioctl(self._master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def _read(self) -> None:
        # Closing a descriptor does not hang up while somebody reads it.
        while not self._hung_up.is_set():
            if not select.select([self._master], [], [], 0.05)[0]:
                continue
            try:
                data = os.read(self._master, PACKET if self.bytes_per_s else 65536)
            except OSError:
                break
            if self.bytes_per_s:
                time.sleep(len(data) / self.bytes_per_s)
            with self._lock:
                self.received += len(data)
                if len(self.kept) < KEPT:
                    self.kept += data
                self._stream.feed(self._decoder.decode(data))


def own_folders(folder: Path, **more: str) -> dict[str, str]:
    """Return an environment in which the program keeps everything below `folder`."""
    return {
        "DECK_RUN_DIR": str(folder / "run"),
        "DECK_LOG_DIR": str(folder / "logs"),
        "XDG_CONFIG_HOME": str(folder / "config"),
        "XDG_STATE_HOME": str(folder / "state"),
        "LANG": "C.UTF-8",
        **more,
    }


def _take_terminal() -> None:
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


def _colour(name: str) -> str | None:
    if name == "default":
        return None
    if len(name) == 6 and all(digit in "0123456789abcdefABCDEF" for digit in name):
        return f"#{name}"
    return {"brown": "yellow"}.get(name, name.replace("bright", "bright_"))
