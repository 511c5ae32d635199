"""Make or bring up to date the virtual environment that `make` works in.

Usage: setup.py VENV, run by the Python that the environment is to be made of.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parent.parent
LOG = ROOT / ".setup.log"
TAIL = 25


class StepError(Exception):
    """A command of the set-up ended with an error; its output is in the log."""


def say(text: str, end: str = "\n") -> None:
    """Tell the person at the terminal, whose standard output belongs to `deck`."""
    print(text, file=sys.stderr, flush=True, end=end)


@contextlib.contextmanager
def only_one() -> Iterator[None]:
    """Let two `make` in one tree set up one after the other."""
    folder = os.open(ROOT, os.O_RDONLY)
    # A pip that outlives this process still writes, so it keeps the lock.
    os.set_inheritable(folder, True)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        yield
    finally:
        os.close(folder)


def step(what: str, *command: str | Path) -> None:
    """Run one command with its output in the log."""
    started = time.monotonic()
    say(f"  {what} ... ", end="")
    with LOG.open("ab") as log:
        log.write(os.fsencode(f"\n$ {' '.join(map(str, command))}\n"))
        log.flush()
        code = subprocess.call(
            command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=log, stderr=log, close_fds=False
        )
    if code:
        say("failed")
    if code < 0:
        raise ChildProcessError(f"{what}: killed by signal {-code}")
    if code:
        raise StepError(what)
    say(f"{time.monotonic() - started:.0f} s")


def fingerprint(folder: Path) -> str:
    """Return a digest of the names and contents of all files in a folder."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            digest.update(f"{path.relative_to(folder)}\0".encode())
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


class Environment:
    """A virtual environment and the marks that tell how far it got."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.python = folder / "bin" / "python"
        self.ready = folder / ".ready"
        self.unfinished = folder / ".unfinished"
        self.interfaces = folder / ".interfaces"

    def identity(self) -> bytes:
        """Return what stops being true when the tree is moved or Python is replaced.

        scripts/sound.sh puts the same words together and compares.
        """
        return os.fsencode(f"{self.folder.resolve()} {self.python.resolve()}\n")

    def is_sound(self) -> bool:
        """Tell whether this was finished, here, with the Python that is asked for."""
        if os.environ.get("PYTHON") and self.python.resolve() != Path(sys.executable).resolve():
            return False
        return not self.unfinished.exists() and read(self.ready) == self.identity()

    def update(self) -> None:
        """Bring the environment to what pyproject.toml and interfaces/ ask for."""
        if not self.is_sound():
            step("virtual environment", sys.executable, "-m", "venv", "--clear", self.folder)
        # What pip left half done looks whole to the next pip. When pip itself gives
        # up it undoes its work; when it is killed, this mark stays behind.
        self.unfinished.touch()
        try:
            self.install()
        except StepError:
            self.unfinished.unlink()
            raise
        self.unfinished.unlink()
        self.ready.write_bytes(self.identity())

    def install(self) -> None:
        """Install Deck with all it needs, and the message types if they have changed."""
        pip = (self.python, "-m", "pip", "install", "--disable-pip-version-check")
        step("Deck, ROS 2 and their libraries", *pip, "--editable", ".[ros,test]")
        wanted = fingerprint(ROOT / "interfaces")
        if read(self.interfaces) == wanted.encode():
            return
        self.interfaces.unlink(missing_ok=True)
        step("message types in interfaces/", *pip, "--force-reinstall", "--no-deps", "./interfaces")
        self.interfaces.write_text(wanted)


def read(path: Path) -> bytes:
    """Return the contents of a file, or nothing if it is not there."""
    return path.read_bytes() if path.is_file() else b""


def set_up(environment: Environment) -> None:
    """Do what is to be done, unless another `make` did it while this one waited."""
    asked = time.time()
    with only_one():
        if environment.is_sound() and environment.ready.stat().st_mtime > asked:
            return
        version = "{}.{}.{}".format(*sys.version_info)
        say(f"deck: setting up {environment.folder} with Python {version}, 1 to 3 minutes at first")
        LOG.write_bytes(b"")
        environment.update()
        say("deck: set-up complete")


def main(folder: str) -> int:
    """Set up, and on failure show what the failing command said last."""
    try:
        set_up(Environment(Path(folder).absolute()))
    except StepError as failed:
        say("\n".join(read(LOG).decode(errors="replace").splitlines()[-TAIL:]))
        say(f"deck: failed at: {failed}; the whole log is in {LOG}")
    except OSError as error:
        say(f"deck: cannot set up here: {error}")
    except KeyboardInterrupt:
        say("\ndeck: set-up interrupted; the next `make` begins it anew")
    else:
        return 0
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
