"""What a shell and a foreign program need to use ROS as Deck does: Python, `ros2`.

`launcher/prefix` is laid out like a folder that colcon installs into: `bin` has the command `ros2`,
`lib` the nodes of the lessons as executables of the package `deck_nodes`, `share` the ament index.
The command is not in the environment's own `bin`, where it would replace the real `ros2` of a
RoboStack environment.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

PREFIX = Path(__file__).resolve().with_name("prefix")
COMMANDS = PREFIX / "bin"
PYTHON = "DECK_PYTHON"
"""The variable that tells the programs in the prefix which Python to run on."""
AMENT = "AMENT_PREFIX_PATH"
COLCON_LOG = "COLCON_LOG_LEVEL"
_INDEX = "share/ament_index"
_MARK = b"The command ros2 of Deck"
_ANSWERS_WITHIN_S = 20.0

BOOTSTRAP_DONE = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
"""Set by the ROS wheels once LD_LIBRARY_PATH points into this environment."""


def without_wheels(environ: Mapping[str, str]) -> dict[str, str | None]:
    """Return changes for programs of another environment, which must not inherit the ROS wheels'.

    They would find the wheels' libraries before their own; a Python of this environment sets the
    variables again. None unsets.
    """
    if BOOTSTRAP_DONE not in environ:
        return {}
    parts = environ.get("LD_LIBRARY_PATH", "").split(os.pathsep)
    others = [part for part in parts if part and not part.startswith(sys.prefix)]
    return {BOOTSTRAP_DONE: None, "LD_LIBRARY_PATH": os.pathsep.join(others) or None}


def ros_tools(environ: Mapping[str, str]) -> dict[str, str]:
    """Return the variables with which `python`, `ros2` and the ament index are found."""
    first = own_folders(environ)
    return {
        PYTHON: sys.executable,
        "PATH": os.pathsep.join([*first, *_without(_path(environ), first)]),
        AMENT: os.pathsep.join(prefixes(environ)),
        # It warns of every prefix that colcon has not made, as the wheels' is.
        COLCON_LOG: environ.get(COLCON_LOG, "error"),
    }


def own_folders(environ: Mapping[str, str]) -> list[str]:
    """Return the folders that come first on the path; with a real ROS its own `ros2` is used."""
    python = [str(Path(sys.executable).parent)] if sys.prefix != sys.base_prefix else []
    return python if real_ros2(environ) is not None else [str(COMMANDS), *python]


def prefixes(environ: Mapping[str, str]) -> list[str]:
    """Return the folders with an ament index: those of the environment, the wheels', Deck's own.

    Deck's is last, so that a package of the same name replaces it.
    """
    given = [part for part in environ.get(AMENT, "").split(os.pathsep) if part]
    wheels = [sys.prefix] if (Path(sys.prefix) / _INDEX).is_dir() else []
    ours = [*wheels, str(PREFIX)]
    return [*_without(given, ours), *ours]


def real_ros2(environ: Mapping[str, str]) -> str | None:
    """Return the path of a `ros2` that is not Deck's and that works; None if there is none."""
    for folder in _path(environ):
        file = Path(folder) / "ros2"
        if os.access(file, os.X_OK) and file.is_file() and not _is_decks(file):
            return str(file) if _works(file, environ) else None
    return None


def _path(environ: Mapping[str, str]) -> list[str]:
    return environ.get("PATH", os.defpath).split(os.pathsep)


def _without(places: list[str], others: list[str]) -> list[str]:
    return [place for place in places if place not in others]


def _is_decks(file: Path) -> bool:
    """Whether it is the command of this or of another Deck."""
    with file.open("rb") as opened:
        return _MARK in opened.read(200)


def _works(file: Path, environ: Mapping[str, str]) -> bool:
    """Whether it can print its help: what is left of a ROS that was removed cannot."""
    changed = {**environ, **without_wheels(environ)}
    env = {name: value for name, value in changed.items() if value is not None}
    try:
        done = subprocess.run([file, "--help"], env=env, capture_output=True, timeout=_ANSWERS_WITHIN_S, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0
