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


class StepFailed(Exception):
    """A command of the set-up ended with an error; its output is in the log."""


def say(text: str) -> None:
    """Tell the person at the terminal, whose standard output belongs to `deck`."""
    print(text, file=sys.stderr, flush=True)


@contextlib.contextmanager
def only_one() -> Iterator[None]:
    """Let two `make` in one tree set up one after the other."""
    folder = os.open(ROOT, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        yield
    finally:
        os.close(folder)


def step(what: str, *command: str | Path) -> None:
    """Run one command with its output in the log."""
    started = time.monotonic()
    say(f"  {what} ...")
    with LOG.open("a") as log:
        log.write(f"\n$ {' '.join(map(str, command))}\n")
        log.flush()
        code = subprocess.call(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
    if code:
        raise StepFailed(what)
    say(f"  {what}: {time.monotonic() - started:.0f} s")


def fingerprint(folder: Path) -> str:
    """Return a digest of the names and contents of all files in a folder."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            digest.update(f"{path.relative_to(folder)}\0".encode())
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def identity(venv: Path) -> str:
    """Return what stops being true when the tree is moved or Python is replaced.

    The Makefile computes the same words in the shell and compares.
    """
    return f"{venv.resolve()} {(venv / 'bin' / 'python').resolve()}\n"


def text(path: Path) -> str:
    """Return the contents of a file, or nothing if it is not there."""
    return path.read_text() if path.is_file() else ""


def install(venv: Path) -> None:
    """Bring the environment to what pyproject.toml and interfaces/ ask for."""
    ready, built = venv / ".ready", venv / ".interfaces"
    # Half an installation looks whole to pip, so one that was cut short is begun anew.
    if text(ready) != identity(venv):
        step("virtual environment", sys.executable, "-m", "venv", "--clear", venv)
    ready.unlink(missing_ok=True)
    pip = [venv / "bin" / "python", "-m", "pip", "install", "--disable-pip-version-check"]
    step("Deck, ROS 2 and their libraries", *pip, "--editable", ".[ros,test]")
    wanted = fingerprint(ROOT / "interfaces")
    if text(built) != wanted:
        built.unlink(missing_ok=True)
        step("message types in interfaces/", *pip, "--force-reinstall", "--no-deps", "./interfaces")
        built.write_text(wanted)
    ready.write_text(identity(venv))


def main(venv: Path) -> int:
    """Set up, and on failure show what the failing command said last."""
    version = "{}.{}.{}".format(*sys.version_info)
    with only_one():
        say(f"deck: setting up {venv} with Python {version} (the first time takes 1 to 3 minutes)")
        LOG.write_text("")
        try:
            install(venv)
        except StepFailed as failed:
            say("\n".join(text(LOG).splitlines()[-TAIL:]))
            say(f"deck: failed at: {failed}. The whole log is in {LOG}")
            return 1
        except KeyboardInterrupt:
            say("deck: set-up interrupted; the next `make` begins it anew")
            return 130
    say("deck: set-up complete")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).absolute()))
