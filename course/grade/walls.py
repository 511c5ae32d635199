"""Walls around a grading: namespaces of its own, in which the rest of this machine is not.

All of it is inside, the judge and Deck's nodes too, so that they meet the learner's over a loopback
interface and a shared memory of their own. What the learner's nodes may do to the others inside is
the affair of `launcher.processes.confinement`.

bubblewrap (bwrap) makes them where it is installed, since it may where programs in general may not;
`course.grade.walled` does elsewhere.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING

import course
from course.grade.limits import IN_MEMORY_BYTES
from launcher.errors import LauncherError
from launcher.node_program import INSTALLATION
from launcher.profile.defaults import FOLDERS_OWN
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.lessons.lesson import LessonFolder

HIDDEN = ("/tmp", "/var/tmp", "/run")
"""Empty inside, as is the home: where programs have their sockets."""
_LISTS_OF_FOLDERS = (
    "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "COLCON_PREFIX_PATH", "LD_LIBRARY_PATH", "PYTHONPATH",
)  # fmt: skip
_PROFILES_OF_DDS = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")
_TRIED_WITHIN_S = 300.0
"""A trial takes a second, and a minute on a machine with thirty processes at work."""
_TRIAL = "import sys; from launcher.profile.load import load_profile; load_profile(sys.argv[1])"


class Walls(Enum):
    """What they are made by."""

    BUBBLEWRAP = "bubblewrap"
    NAMESPACES = "namespaces"
    NONE = "none"
    """By nothing: the grading is among all that its user runs."""


@dataclass(frozen=True)
class Inside:
    """What there is inside, beside the system's own folders: nothing else of these."""

    hidden: tuple[str, ...]
    readable: tuple[str, ...]
    writable: tuple[str, ...]

    @classmethod
    def of(cls, lesson: LessonFolder, *places: Path, apart: Sequence[Path] = ()) -> Inside:
        """What a grading needs: Deck, Python, ROS, the lesson, and folders to write in.

        Nothing is seen of what is in the folders that are kept `apart`.
        """
        home = Path.home()
        hidden = [*HIDDEN, *([] if home == Path("/") else [str(home)]), *map(str, apart)]
        wanted = [
            *(INSTALLATION, sys.prefix, sys.base_prefix, *sys.path, str(lesson.path)),
            *(part for name in _LISTS_OF_FOLDERS for part in os.environ.get(name, "").split(":")),
            *(os.environ.get(name, "") for name in _PROFILES_OF_DDS),
        ]
        out_of_sight = {Path(each).resolve() for each in hidden if Path(each).is_dir()}
        there = {Path(os.path.abspath(each)) for each in wanted if each and Path(each).exists()}  # noqa: PTH100
        there = (there | {each.resolve() for each in there}) - out_of_sight
        return cls(
            _differing(out_of_sight, there, unless_any=True),
            _differing(there, out_of_sight),
            tuple(str(place.resolve()) for place in places),
        )

    def layers(self) -> list[tuple[str, bool]]:
        """Return what to hide (true) and what to bring back (false), each over what it is in."""
        both = [*((each, True) for each in self.hidden), *((each, False) for each in self.readable)]
        return sorted(both, key=lambda layer: (layer[0].count("/"), layer))


def _differing(folders: set[Path], others: set[Path], *, unless_any: bool = False) -> tuple[str, ...]:
    """Return those that are within one of the others, and in none of their own kind below it.

    `unless_any`: also those that are within none at all.
    """

    def depth(path: Path, among: set[Path]) -> int:
        return max((len(each.parts) for each in among & {*path.parents}), default=0)

    return tuple(
        str(each)
        for each in sorted(folders)
        if depth(each, others) > depth(each, folders)
        or (unless_any and not depth(each, others) and not depth(each, folders))
    )


def walls_for(lesson: LessonFolder) -> Walls:
    """Return the best that can be had here; tried, in full, with this lesson.

    Raises:
        LauncherError: if a trial does not end: without its answer nothing is to be graded.
    """
    kinds = (Walls.BUBBLEWRAP, Walls.NAMESPACES)
    return next((kind for kind in kinds if _hold(kind, lesson)), Walls.NONE)


def _hold(kind: Walls, lesson: LessonFolder) -> bool:
    """Whether they can be made, and the lesson be read inside."""
    trial = (sys.executable, "-c", _TRIAL, str(lesson.path / FOLDERS_OWN))
    with tempfile.TemporaryDirectory(prefix="deck-grade-") as place:
        command = within(kind, lesson, Path(place), trial)
        return command is not None and _runs(command)


def _runs(command: Sequence[str]) -> bool:
    """Whether a trial succeeds; one that was not finished is no answer.

    Raises:
        LauncherError: if it is not finished after a long time.
    """
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


def within(
    kind: Walls, lesson: LessonFolder, place: Path, command: Sequence[str], *, apart: Sequence[Path] = ()
) -> Sequence[str] | None:
    """Return the command that runs another one inside, where it writes in `place` only.

    None if there is none on this machine.
    """
    if kind is Walls.NONE:
        return command
    inside = Inside.of(lesson, place, apart=apart)
    if kind is Walls.NAMESPACES:
        root = place / "root"
        root.mkdir(exist_ok=True)
        described = json.dumps({"layers": inside.layers(), "writable": inside.writable})
        return (sys.executable, "-m", "course.grade.walled", str(root), described, *command)
    bubblewrap = shutil.which("bwrap")
    return None if bubblewrap is None else (bubblewrap, *_options(inside), "--", *command)


def _options(inside: Inside) -> list[str]:
    options = ["--unshare-user", "--unshare-pid", "--unshare-net", "--unshare-ipc"]
    options += ["--as-pid-1", "--die-with-parent", "--cap-drop", "ALL", "--ro-bind", "/", "/"]
    options += ["--dev", "/dev", "--proc", "/proc"]
    for path, is_hidden in (("/dev/shm", True), *inside.layers()):
        hiding = ["--size", str(IN_MEMORY_BYTES), "--tmpfs", path]
        options += hiding if is_hidden else ["--ro-bind", path, path]
    for path in inside.writable:
        options += ["--bind", path, path]
    return options
