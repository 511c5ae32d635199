"""Rerun's own program: the window, or the server that a page reads from.

It is configured to listen on this machine alone, where by itself it would listen on all addresses,
and to report to nobody how it is used.
"""

from __future__ import annotations

import ctypes
import json
import os
import signal
import subprocess
import tempfile
import time
from typing import TYPE_CHECKING

import psutil
from platformdirs import user_cache_path

from text.plain import plain
from text.sentences import say
from view.place import HERE, ViewError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from typing_extensions import Self

READY_S = 30.0
END_S = 3.0
MEMORY = "512MiB"
"""What the server keeps for a page that is opened later, or again; older data are dropped."""
FORCED = "FORCE_RERUN_ANALYTICS"
_PR_SET_PDEATHSIG = 1
_LINES = 2


class Viewer:
    """A running program of Rerun; it ends with this process, however that ends."""

    def __init__(self, program: Path, data_port: int, page_port: int | None) -> None:
        """Start it: a window of its own, or a server of pages at `page_port`.

        Raises ViewError if it does not come up.
        """
        self.data_port = data_port
        self.page_port = page_port
        self._log = tempfile.TemporaryFile()  # noqa: SIM115 - as long as the program runs
        serving = () if page_port is None else ("--serve-web", "--web-viewer-port", str(page_port))
        command: Sequence[str] = (
            *(str(program), "--bind", HERE, "--port", str(data_port)),
            *("--server-memory-limit", MEMORY, "--hide-welcome-screen"),
            *serving,
        )
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=self._log,
            env=silent_environment(user_cache_path("deck") / "viewer"),
            # Ctrl-C is meant for us, who end it.
            start_new_session=True,
            preexec_fn=_die_with_parent,  # noqa: PLW1509 - our threads only wait, without a lock
        )
        try:
            self._wait_until_it_listens()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def ended(self) -> bool:
        """Whether it has ended, as when its window is closed."""
        return self._process.poll() is not None

    @property
    def fault(self) -> str:
        """Why it ended, empty if it was closed by its user."""
        code = self._process.poll()
        if not code:
            return ""
        return say("Rerun ended with code {code}: {words}", code=code, words=self._last_words())

    def close(self) -> None:
        if not self.ended:
            self._process.terminate()
            try:
                self._process.wait(END_S)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._log.close()

    def _wait_until_it_listens(self) -> None:
        deadline_s = time.monotonic() + READY_S
        ports = {port for port in (self.data_port, self.page_port) if port is not None}
        # Another's that starts meanwhile may have taken one of them: then this one will end.
        while not ports <= listened_at(self._process.pid):
            if self.ended:
                code, words = self._process.returncode, self._last_words()
                raise ViewError(say("Rerun ended with code {code}: {words}", code=code, words=words))
            if time.monotonic() > deadline_s:
                raise ViewError(say("Rerun did not come up within {seconds} s", seconds=int(READY_S)))
            time.sleep(0.02)

    def _last_words(self) -> str:
        self._log.seek(0)
        lines = self._log.read().decode(errors="replace").strip().splitlines()
        return plain(" ".join(lines[-_LINES:]), 400)


def silent_environment(folder: Path) -> dict[str, str]:
    """Return an environment in which Rerun reports to nobody: its settings are in `folder`.

    Source: `rerun analytics disable`, which writes this file for the whole account; and CI, in
    which Rerun reports nothing either.
    """
    settings = folder / "rerun" / "analytics.json"
    settings.parent.mkdir(parents=True, exist_ok=True)
    said = {
        "analytics_enabled": False,
        "analytics_id": "",
        "metadata": {},
        "config_file_path": str(settings),
        "data_dir_path": str(folder / "data"),
    }
    settings.write_text(json.dumps(said))
    others = {name: value for name, value in os.environ.items() if name != FORCED}
    return {**others, "XDG_CONFIG_HOME": str(folder), "CI": "true", "NO_COLOR": "1"}


def listened_at(pid: int) -> set[int]:
    """Return the ports of IPv4 at which a process listens."""
    try:
        found = psutil.Process(pid).net_connections("tcp4")
    except psutil.Error:  # It has ended.
        return set()
    return {one.laddr.port for one in found if one.status == psutil.CONN_LISTEN}


def _die_with_parent() -> None:
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, ctypes.c_ulong(signal.SIGTERM), 0, 0, 0)
