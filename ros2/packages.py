"""Installed packages: which there are, in which prefix, and their executables.

Each prefix has an ament index, with a file for each package.
"""

from __future__ import annotations

import os
import re
from glob import escape
from pathlib import Path

from launcher.ros_tools import prefixes

MOST = 4000
"""Characters of a program that are looked at."""
INDEX = Path("share/ament_index/resource_index/packages")


CONFIG = """\
[develop]
script_dir=$base/lib/{name}
[install]
install_scripts=$base/lib/{name}
"""
"""setup.cfg of a package: without it, setuptools puts programs into bin/."""


class NoPackageError(RuntimeError):
    """There is no such package."""


def packages() -> dict[str, Path]:
    """Return package -> prefix; the first prefix that has it counts."""
    found: dict[str, Path] = {}
    for prefix in map(Path, prefixes(os.environ)):
        folder = prefix / INDEX
        if folder.is_dir():
            for file in sorted(folder.iterdir()):
                if not file.name.startswith("."):
                    found.setdefault(file.name, prefix)
    return found


def prefix_of(package: str) -> Path:
    """Return the prefix of a package.

    Raises:
        NoPackageError: if there is none.
    """
    for prefix in map(Path, prefixes(os.environ)):
        if package and "/" not in package and (prefix / INDEX / package).is_file():
            return prefix
    raise NoPackageError(package)


def executables(package: str) -> list[Path]:
    """Return the programs of a package; raises NoPackageError."""
    found = []
    for folder, folders, files in os.walk(prefix_of(package) / "lib" / package):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        places = (Path(folder) / name for name in sorted(files))
        found += [place for place in places if os.access(place, os.X_OK)]
    return found


def misplaced(package: str, program: str) -> Path | None:
    """Return where a program of a package is that its set-up has put elsewhere; None: nowhere."""
    prefix = prefix_of(package)
    for place in (prefix / "bin" / program, *sorted(prefix.glob(f"lib/*/{escape(program)}"))):
        try:
            text = place.read_text(encoding="utf-8")[:MOST]
        except (OSError, ValueError):
            continue
        # As setuptools writes it: others may have a program of that name in the same folder.
        if re.search(rf"(?<![\w.-]){re.escape(package)}(?:==|\.|['\"])", text):
            return place
    return None
