"""Create or update the virtual environment that `make` uses.

Usage: environment.py VENV, run by the Python that the environment is to use; it calls itself as
environment.py --build-interfaces WHEELS FOLDER. Packages from an index are listed in locked/.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

# Run by its path, before there is an environment: modules beside it have bare names.
from distro import FIRST, MARK, UnknownDistroError, for_distro, wanted_distro
from interface_names import wrong_names
from setup_words import told
from wheel_cache import WheelCache

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ROOT = Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "setup"
LOCKED = ROOT / "locked"
TAIL = 25
TICK_S = 1.0
BUILD = "--build-interfaces"
PLAIN = re.compile(r"[\w/.,:=@%+~ -]+")
"""Paths that need no quoting in CMake and the shells it starts."""
BUILT = re.compile(rb"^\s*\[(\d+)/(\d+)\]", re.MULTILINE)
"""What ninja says before each file that it builds."""
REQUIRE = ("install", "--no-deps", "--require-hashes")
"""Packages after this are installed only at the locked version, and only from the locked file.

That file names every dependency. Were pip to look for them itself, it would take the newest release
of a library that is asked for with an extra, and then refuse it.
"""


class StepError(Exception):
    """A command of the set-up failed."""

    def __init__(self, what: str, log: Path) -> None:
        super().__init__(what)
        self.log = log


def say(text: str, end: str = "\n") -> None:
    """Write to the terminal on standard error: standard output belongs to `deck`."""
    print(text, file=sys.stderr, flush=True, end=end)


@contextlib.contextmanager
def only_one() -> Iterator[None]:
    """Make two `make` in one tree set up one after the other."""
    folder = os.open(ROOT, os.O_RDONLY)
    # A pip that outlives this process is still writing, so it keeps the lock.
    os.set_inheritable(folder, True)
    try:
        try:
            fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say(told("deck: another `make` is setting up here, waiting for it"))
            fcntl.flock(folder, fcntl.LOCK_EX)
        yield
    finally:
        os.close(folder)


class WrongNameError(Exception):
    """Something in interfaces/ has a name that ROS does not allow."""


class Step:
    """One running command of the set-up, with its own log."""

    ended = 0
    """How many steps are finished, including skipped ones."""
    total = 0
    """How many steps there are in all."""

    def __init__(self, what: str, *command: str | Path, done: Callable[[Path], str] = lambda _log: "") -> None:
        """`what` is one of the words of setup_words; `done` says from the log how far it has come."""
        self.what = told(what)
        self.log = WORK / f"{what.split(maxsplit=1)[0].lower()}.log"
        self.started = time.monotonic()
        self.done = done
        with self.log.open("wb") as log:
            self.process = subprocess.Popen(
                command,
                cwd=ROOT,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                close_fds=False,
                # Its own process group, which can be ended with everything it has started.
                start_new_session=True,
            )

    def finish(self) -> None:
        """Wait for the command, show progress, and report how long it took."""
        screen = sys.stderr.isatty()
        line = heading(self.what)
        if not screen:
            say(line, end="")
        try:
            while True:
                try:
                    code = self.process.wait(TICK_S if screen else None)
                    break
                except subprocess.TimeoutExpired:
                    done = self.done(self.log)
                    say(f"\r\x1b[K{line}{done}{', ' if done else ''}{self.seconds()}", end="")
        except KeyboardInterrupt:
            self.abandon()
            raise
        ended = self.seconds() if code == 0 else told("failed")
        say(f"\r\x1b[K{line}{ended}" if screen else ended)
        if code < 0:
            raise ChildProcessError(told("%s: killed by signal %d", self.what, -code))
        if code:
            raise StepError(self.what, self.log)

    def seconds(self) -> str:
        """Return how long the command has been running."""
        return told("%d s", time.monotonic() - self.started)

    def abandon(self) -> None:
        """Stop the command and everything it has started, if it is still running."""
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()


def heading(what: str) -> str:
    """Return the start of the next step's line."""
    Step.ended += 1
    return told("  %d of %d: %s ... ", Step.ended, Step.total, what)


def locked_files() -> list[Path]:
    """Return the files with what Deck needs, and with the ROS that it runs on."""
    return [LOCKED / "deck.txt", LOCKED / f"ros-{wanted_distro()}.txt"]


def loaded(log: Path) -> str:
    """Return how many of the locked packages pip has loaded by its log; while it unpacks them, all."""
    lines = read(log).decode(errors="replace").splitlines()
    left_out = sum(line.startswith("Ignoring ") for line in lines)
    loaded = sum(line.startswith("Collecting ") for line in lines)
    wanted = sum("==" in line for file in locked_files() for line in file.read_text().splitlines())
    return f"{loaded}/{wanted - left_out}"


def built(log: Path) -> str:
    """Return how much of the message types is built, by what the build itself says last."""
    said = BUILT.findall(read(log))
    return f"{100 * int(said[-1][0]) // int(said[-1][1])} %" if said else ""


def wanted_interfaces() -> str:
    """Return for which ROS, and a digest of the sources and tools of the message types."""
    return wanted_distro() + fingerprint(ROOT / "interfaces") + fingerprint(LOCKED)


def fingerprint(folder: Path) -> str:
    """Return a digest of the names and contents of all files in a folder."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            digest.update(f"{path.relative_to(folder)}\0".encode())
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


class Environment:
    """A virtual environment, with marks that record how far its set-up has got."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.python = folder / "bin" / "python"
        self.ready = folder / ".ready"
        self.unfinished = folder / ".unfinished"
        self.interfaces = folder / ".interfaces"
        self.distro = folder / MARK

    def identity(self) -> bytes:
        """Return a text that changes when the tree is moved or Python is replaced.

        scripts/sound.sh builds the same text and compares it.
        """
        return os.fsencode(f"{self.folder.resolve()} {self.python.resolve()}\n")

    def is_sound(self) -> bool:
        """Return whether the set-up was finished, here, with the requested Python and ROS."""
        if os.environ.get("PYTHON") and self.python.resolve() != Path(sys.executable).resolve():
            return False
        if (read(self.distro).decode() or FIRST) != wanted_distro(self.folder):
            return False
        return not self.unfinished.exists() and read(self.ready) == self.identity()

    def update(self) -> None:
        """Update the environment to match pyproject.toml and interfaces/."""
        sound, distro = self.is_sound(), wanted_distro(self.folder)
        # For the steps, which are programs of their own.
        os.environ["ROS"] = distro
        changed = not sound or read(self.interfaces) != wanted_interfaces().encode()
        if changed and (wrong := wrong_names(ROOT / "interfaces")):
            raise WrongNameError("\n".join(wrong))
        Step.ended, Step.total = 0, (not sound) + 2 + 2 * changed
        if not sound:
            self.begin()
            self.distro.write_text(distro)
            Step("Virtual environment", sys.executable, "-m", "venv", self.folder).finish()
        # A half-finished installation looks complete to the next pip. When pip fails it undoes its
        # work; when it is killed, or had nothing whole to go back to, this mark stays behind.
        self.unfinished.touch()
        try:
            self.install()
        except StepError:
            if sound:
                self.unfinished.unlink()
            raise
        self.unfinished.unlink()
        self.ready.write_bytes(self.identity())

    def begin(self) -> None:
        """Create the folder, or empty it if it was made by this script; else leave it alone."""
        self.folder.mkdir(exist_ok=True)
        if any(self.folder.iterdir()) and not (self.ready.exists() or self.unfinished.exists()):
            raise FileExistsError(told("%s already exists and was not made by `make`; move it away", self.folder))
        # The mark stays: whatever happens now, the folder is known to be ours.
        self.unfinished.touch()
        for entry in self.folder.iterdir():
            if entry.is_dir() and not entry.is_symlink():
                shutil.rmtree(entry)
            elif entry != self.unfinished:
                entry.unlink()

    def install(self) -> None:
        """Install Deck and its requirements, and the message types if they have changed."""
        wanted = wanted_interfaces()
        if read(self.interfaces) == wanted.encode():
            self.install_deck()
            return
        wheels = WORK / "wheels"
        shutil.rmtree(wheels, ignore_errors=True)
        scripts = (Path(__file__), Path(__file__).with_name("distro.py"))
        builder = hashlib.sha256(b"".join(script.read_bytes() for script in scripts)).hexdigest()
        kept = WheelCache(wanted, builder)
        if kept.fetch(wheels):
            self.install_deck()
            say(heading(told("Message types")) + told("kept from an earlier set-up"))
        else:
            self.build(wheels)
            kept.keep(wheels)
        self.interfaces.unlink(missing_ok=True)
        force = ("--force-reinstall", "--no-deps", "--no-index")
        Step("Installing the message types", *pip(self.python, "install", *force, *wheels.iterdir())).finish()
        self.interfaces.write_text(wanted)

    def build(self, wheels: Path) -> None:
        """Install Deck and build the message types, in parallel."""
        with folder_for_cmake() as folder:
            build = Step(
                "Message types, built meanwhile", sys.executable, __file__, BUILD, wheels, folder, done=built
            )
            try:
                self.install_deck()
                build.finish()
            finally:
                build.abandon()

    def install_deck(self) -> None:
        """Install ROS 2, Deck's libraries and the test tools, then Deck itself, editable."""
        named = [word for file in locked_files() for word in ("--requirement", file)]
        Step("Libraries of Deck and ROS 2", *pip(self.python, *REQUIRE, *named), done=loaded).finish()
        bare = ("install", "--no-deps", "--no-build-isolation", "--editable", ".")
        Step("Deck itself", *pip(self.python, *bare)).finish()


def pip(python: Path, *words: str | Path) -> tuple[str | Path, ...]:
    """Return the command that runs the pip of an environment."""
    return (python, "-m", "pip", "--disable-pip-version-check", *words)


@contextlib.contextmanager
def folder_for_cmake() -> Iterator[Path]:
    """Yield a folder to build in: in this tree, or elsewhere if its path would need quoting.

    The commands that rosidl writes into makefiles do not quote paths.
    """
    inside = WORK / "build-environment"
    if PLAIN.fullmatch(str(inside)):
        yield inside
        return
    for place in (tempfile.gettempdir(), "/var/tmp", "/tmp"):
        if PLAIN.fullmatch(place) and os.access(place, os.W_OK | os.X_OK):
            with tempfile.TemporaryDirectory(prefix="deck-build-", dir=place) as folder:
                yield Path(folder)
            return
    raise OSError(told("%s: CMake cannot build in a folder of that name; move it elsewhere", ROOT))


def build_interfaces(wheels: Path, folder: Path) -> None:
    """Build the wheel of the message types, in an environment with its locked requirements."""
    sources = folder / "interfaces"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT / "interfaces", sources)
    distro, project = wanted_distro(), sources / "pyproject.toml"
    project.write_text(for_distro(project.read_text(), distro))
    folder /= "environment"
    python = folder / "bin" / "python"
    environ = os.environ | {"PIP_NO_COMPILE": "1"}
    # Pythons started by a build must not import half-installed packages.
    environ["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] = "1"
    environ["PATH"] = f"{python.parent}{os.pathsep}{environ.get('PATH', os.defpath)}"
    made = ("wheel", "--verbose", "--no-deps", "--no-build-isolation", "--wheel-dir", wheels, sources)
    for command in (
        (sys.executable, "-m", "venv", "--clear", folder),
        pip(python, *REQUIRE, "--requirement", LOCKED / f"interfaces-{distro}.txt"),
        pip(python, *made),
    ):
        subprocess.run(command, cwd=ROOT, env=environ, check=True, close_fds=False)
    shutil.rmtree(folder.parent)


def read(path: Path) -> bytes:
    """Return the contents of a file, empty if it does not exist."""
    return path.read_bytes() if path.is_file() else b""


def set_up(environment: Environment) -> None:
    """Update the environment, unless another `make` did it while this one waited."""
    asked = time.time()
    with only_one():
        if environment.is_sound() and environment.ready.stat().st_mtime > asked:
            return
        version = "{}.{}.{}".format(*sys.version_info)
        say(told("deck: setting up %s with Python %s", environment.folder, version))
        say(told("  1 to 3 minutes at first, more on a busy machine"))
        WORK.mkdir(parents=True, exist_ok=True)
        environment.update()
        say(told("deck: set-up complete"))


def main(folder: str) -> int:
    """Set up; on failure show the last lines of the failing command."""
    try:
        set_up(Environment(Path(folder).absolute()))
    except StepError as failed:
        say("\n".join(read(failed.log).decode(errors="replace").splitlines()[-TAIL:]))
        say(told("deck: failed at: %s; the whole log is in %s", failed, failed.log))
    except UnknownDistroError as unknown:
        say(told("deck: ROS=%s is neither jazzy nor kilted", unknown))
        return 2
    except WrongNameError as wrong:
        say(str(wrong))
        say(told("deck: nothing is built before these names are fixed"))
        return 2
    except OSError as error:
        say(told("deck: cannot set up here: %s", error))
    except KeyboardInterrupt:
        say(told("\ndeck: set-up interrupted; the next `make` starts it again"))
    else:
        return 0
    return 1


if __name__ == "__main__":
    if sys.argv[1] == BUILD:
        try:
            build_interfaces(Path(sys.argv[2]), Path(sys.argv[3]))
        except subprocess.CalledProcessError as failed:
            sys.exit(failed.returncode)
    else:
        sys.exit(main(sys.argv[1]))
