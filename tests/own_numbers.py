"""A namespace in which the next process can be given any number that is free.

Made by unshare(1) of util-linux, as a user's own namespace unless it is root's anyhow: nothing of
the machine is touched.
"""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

GIVE_NEXT = """
def give_next(number):
    with open("/proc/sys/kernel/ns_last_pid", "w") as file:
        file.write(str(number - 1))
"""
"""For the scripts: the next process that is started gets this number."""


def run_with_own_numbers(script: str) -> str:
    """Run Python there, with `give_next`; return what it prints."""
    user = [] if os.getuid() == 0 else ["--user", "--map-root-user"]
    done = subprocess.run(
        [
            *("unshare", *user, "--pid", "--fork", "--mount-proc", "--kill-child"),
            *(sys.executable, "-c", GIVE_NEXT + textwrap.dedent(script)),
        ],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
