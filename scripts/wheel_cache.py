"""Wheels of the message types, kept for the next clone: to build them takes longer than the rest.

They lie in XDG_CACHE_HOME/deck/interfaces, a folder for each that could differ: by the sources, by
what builds them, by the Python and by the machine.
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
    """The wheels of one key, whole or not at all."""

    def __init__(self, *ingredients: str) -> None:
        """Look for what `ingredients`, this Python and this machine make."""
        python = (platform.python_version(), sysconfig.get_config_var("SOABI"))
        machine = (platform.system(), platform.machine(), *platform.libc_ver())
        key = digest_of("\0".join((*ingredients, *map(str, python + machine))).encode())
        self.folder = cache_home() / "deck" / "interfaces" / key

    def fetch(self, wheels: Path) -> bool:
        """Put the kept wheels into a new folder; return False if none can be trusted.

        What is damaged, or could have been written by another user, is as if it were not there.
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
        """Keep these wheels in place of what is there; without a word if that is impossible."""
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
                # Another clone may have been quicker, and its wheels are as good.
                shutil.rmtree(self.folder, ignore_errors=True)
                new.rename(self.folder)
            finally:
                shutil.rmtree(new, ignore_errors=True)

    def _read(self, name: str) -> bytes:
        descriptor = os.open(self.folder / name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        with os.fdopen(descriptor, "rb") as file:
            if not stat.S_ISREG(os.fstat(descriptor).st_mode):
                raise OSError(f"{name} is no file")
            return file.read()


def cache_home() -> Path:
    """Return the user's folder for what can be made again (XDG Base Directory Specification)."""
    given = os.environ.get("XDG_CACHE_HOME", "")
    return Path(given) if given.startswith("/") else Path.home() / ".cache"


def is_ours_alone(folder: Path) -> bool:
    """Whether a folder is this user's, and no other may write into it."""
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.geteuid():
        return False
    return not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def digest_of(content: bytes) -> str:
    """Return the sum that is kept beside a wheel."""
    return hashlib.sha256(content).hexdigest()
