"""A confined process writes and signals no further than it may, and neither do its children."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

from launcher.processes.confinement import Confinement, confinement

TRIES = """
import json, os, subprocess, sys
from launcher.processes.confinement import confine

own, other = sys.argv[1:]
confine([own])

def told(act):
    try:
        act()
    except PermissionError:
        return "refused"
    return "done"

def write(path):
    open(path, "w").close()

child = "import os; os.kill(os.getppid(), 0); open(%r, 'w')" % f"{other}/child"
print(json.dumps({
    "write": told(lambda: write(f"{own}/new")),
    "rename": told(lambda: os.rename(f"{own}/new", f"{own}/newer")),
    "null": told(lambda: write("/dev/null")),
    "write elsewhere": told(lambda: write(f"{other}/new")),
    "remove elsewhere": told(lambda: os.unlink(f"{other}/there")),
    "truncate elsewhere": told(lambda: os.truncate(f"{other}/there", 0)),
    "child": subprocess.run([sys.executable, "-c", child], stderr=-1).stderr.decode(),
    "signal": told(lambda: os.kill(os.getppid(), 0)),
    "read": open(f"{other}/there").read(),
}))
"""


def tried(tmp_path: Path) -> dict[str, str]:
    own, other = tmp_path / "own", tmp_path / "other"
    own.mkdir()
    other.mkdir()
    (other / "there").write_text("text")
    done = subprocess.run(
        [sys.executable, "-c", TRIES, str(own), str(other)], capture_output=True, check=True
    )
    found: dict[str, str] = json.loads(done.stdout)
    return found


def test_what_a_confined_process_may_do(tmp_path: Path) -> None:
    found, kind = tried(tmp_path), confinement()
    assert (found["write"], found["rename"], found["null"]) == ("done", "done", "done")
    if kind is not Confinement.NONE:
        assert found["write elsewhere"] == found["remove elsewhere"] == "refused"
        assert found["read"] == "text"
        assert "Permission denied" in found["child"]
    assert (found["signal"] == "refused") == (kind is Confinement.FULL)
