"""What an examiner leaves behind is ended; other examiners go on."""

from __future__ import annotations

import subprocess
import sys

ADOPTS = """
import os, subprocess
from course.grade.leftovers import descendants, end_adopted
from launcher.processes.prctl import become_subreaper

become_subreaper()
kept = subprocess.Popen(["sleep", "1000"])
subprocess.run(["sh", "-c", "env -i setsid sleep 1000 & env -i sleep 1000 &"], check=True)
assert len(descendants(os.getpid())) > 1
end_adopted([kept.pid])
print([each.pid == kept.pid for each in descendants(os.getpid())])
kept.kill()
kept.wait()
"""


def test_what_was_adopted_is_ended_and_examiners_are_kept() -> None:
    done = subprocess.run([sys.executable, "-c", ADOPTS], capture_output=True, check=True)
    assert done.stdout.decode().strip() == "[True]"
