"""A cache of the message types' wheels for the next clone: building them takes longest.

It is in XDG_CACHE_HOME/deck/interfaces, with a folder for every combination of sources, build
tools, Python and machine.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import platform
import shutil
import stat
import sysconfig
import tempfile
from pathlib import Path

SUMS = "SHA256SUMS"


class WheelCache:
    """The wheels for one key, complete or not at all."""

    def __init__(self, *ingredients: str) -> None:
        """Make the key from `ingredients`, this Python and this machine."""
        python = (platform.python_version(), sysconfig.get_config_var("SOABI"))
        machine = (platform.system(), platform.machine(), *platform.libc_ver())
        key = digest_of("\0".join((*ingredients, *map(str, python + machine))).encode())
        self.folder = cache_home() / "deck" / "interfaces" / key

    def fetch(self, wheels: Path) -> bool:
        """Copy the cached wheels into a new folder; return False if none can be trusted.

        Damaged files, and files that another user could have written, are ignored.
        """
        try:
            if not all(map(is_ours_alone, (self.folder.parent, self.folder))):
                return False
            sums = self._read(SUMS).decode().splitlines()
            found = {name: digest for digest, name in (line.split("  ", 1) for line in sums)}
            contents = {name: self._read(name) for name in found}
        except (OSError, ValueError):
            return False
        sound = all(digest_of(contents[name]) == digest for name, digest in found.items())
        if not (found and sound and all(Path(name).name == name for name in found)):
            return False
        wheels.mkdir(parents=True)
        for name, content in contents.items():
            (wheels / name).write_bytes(content)
        return True

    def keep(self, wheels: Path) -> None:
        """Cache these wheels, replacing older ones; do nothing if that is impossible."""
        with contextlib.suppress(OSError):
            self.folder.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            new = Path(tempfile.mkdtemp(prefix=".new-", dir=self.folder.parent))
            try:
                sums = ""
                for wheel in sorted(wheels.iterdir()):
                    content = wheel.read_bytes()
                    (new / wheel.name).write_bytes(content)
                    sums += f"{digest_of(content)}  {wheel.name}\n"
                (new / SUMS).write_text(sums)
                # Another clone may have been faster; its wheels are just as good.
                shutil.rmtree(self.folder, ignore_errors=True)
                new.rename(self.folder)
            finally:
                shutil.rmtree(new, ignore_errors=True)

    def _read(self, name: str) -> bytes:
        descriptor = os.open(self.folder / name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        with os.fdopen(descriptor, "rb") as file:
            if not stat.S_ISREG(os.fstat(descriptor).st_mode):
                raise OSError(f"{name} is not a file")
            return file.read()


def cache_home() -> Path:
    """Return the user's cache folder (XDG Base Directory Specification)."""
    given = os.environ.get("XDG_CACHE_HOME", "")
    return Path(given) if given.startswith("/") else Path.home() / ".cache"


def is_ours_alone(folder: Path) -> bool:
    """Whether a folder belongs to this user, and nobody else may write to it."""
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.geteuid():
        return False
    return not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def digest_of(content: bytes) -> str:
    """Return the checksum that is stored beside a wheel."""
    return hashlib.sha256(content).hexdigest()
