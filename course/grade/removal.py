"""Removing a folder in which somebody else has worked: nested as deep and closed as it may be.

`shutil.rmtree` calls itself for each folder, and gives up at those that may not be read.
"""

from __future__ import annotations

import os
from contextlib import suppress
from itertools import count
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


def remove_tree(root: Path) -> None:
    """Remove a folder and all in it, as far as that can be; nobody may work in it any more.

    A folder within another is moved up to the root first, so that no path becomes long.
    """
    _open_up(str(root))
    numbers = count()
    folders = [str(root)]
    # The list grows meanwhile.
    for folder in folders:
        folders += _emptied(folder, root, numbers)
    for folder in reversed(folders):
        with suppress(OSError):
            os.rmdir(folder)  # noqa: PTH106


def _emptied(folder: str, root: Path, numbers: Iterator[int]) -> list[str]:
    """Remove the files of a folder, and move its folders up; return where those are now."""
    moved = []
    with suppress(OSError):
        for entry in list(os.scandir(folder)):
            with suppress(OSError):
                if not entry.is_dir(follow_symlinks=False):
                    os.unlink(entry.path)  # noqa: PTH108
                    continue
                _open_up(entry.path)
                target = f"{root}/.removed-{os.getpid()}-{next(numbers)}"
                os.rename(entry.path, target)  # noqa: PTH104
                moved.append(target)
    return moved


def _open_up(folder: str) -> None:
    with suppress(OSError):
        os.chmod(folder, 0o700)  # noqa: PTH101
