"""`make test`: the tests side by side, and what fails in that crowd once more, alone.

What fails alone too is a failure. What passes then is *unsteady*: it stops nothing, is named in the
last lines and in build/unsteady.txt, and is mended or deleted as the next work. More than `MOST`
failures are not tried again: that many say something about the change, or about the machine.

    python -m tests.run [--all] [arguments of pytest]
"""

from __future__ import annotations

import ctypes
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from tests.failures import FAILURES, Failure, read
from tests.machine import PLAIN

if TYPE_CHECKING:
    from collections.abc import Sequence

ROOT = Path(__file__).resolve().parents[1]
UNSTEADY = Path("build", "unsteady.txt")
MOST = 15
WORKERS = 4
CROWD = ("-n", str(WORKERS), "--dist", "loadfile", "--no-loadscope-reorder")
GATE = ("-m", "not nightly", PLAIN)
_SOME_FAILED = 1
"""The exit code of pytest."""
_INTERRUPTED = 130
_PR_SET_CHILD_SUBREAPER = 36


def main(arguments: Sequence[str]) -> int:
    """Run the tests; return 0 if all passed, even if some only alone."""
    words = [word for word in arguments if word != "--all"]
    chosen = () if "--all" in arguments or _names_files(words) else GATE
    UNSTEADY.unlink(missing_ok=True)
    began_s = time.monotonic()
    adopt()
    try:
        code, failed = run([*CROWD, *chosen, *words])
        unsteady: list[Failure] = []
        if code == _SOME_FAILED and 0 < len(failed) <= MOST:
            print(f"\n{len(failed)} failed in the crowd: once more, alone", flush=True)
            code, again = run(["-n", "0", *(each.test for each in failed)])
            lasting = {each.test for each in again}
            unsteady = [each for each in failed if each.test not in lasting]
        elif code == _SOME_FAILED:
            print(f"\nmore than {MOST} failed: they are not tried again")
    except KeyboardInterrupt:
        return _INTERRUPTED
    tell(unsteady)
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(
        f"{'passed' if code == 0 else 'FAILED'}: {len(unsteady)} unsteady,"
        f" {time.monotonic() - began_s:.0f} s,"
        f" {spent.ru_utime + spent.ru_stime:.0f} core-seconds"
        f"{'; make test-all also runs what takes longer' if chosen else ''}",
        flush=True,
    )
    return code


def _names_files(words: Sequence[str]) -> bool:
    """Whether tests are asked for by file or folder: those run whatever their marks."""
    return any(Path(word.partition("::")[0]).exists() for word in words)


def adopt() -> None:
    """Become the parent of what outlives its own, so that its processor time counts."""
    ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def run(arguments: Sequence[str]) -> tuple[int, list[Failure]]:
    """Run pytest once; return its exit code, and what has failed."""
    with tempfile.TemporaryDirectory() as folder:
        told = Path(folder, "failures")
        recording = ("-p", "tests.failures", f"{FAILURES}={told}")
        pytest = subprocess.Popen([sys.executable, "-m", "pytest", *recording, *arguments])
        return _reap_until_ended(pytest), read(told)


def _reap_until_ended(pytest: subprocess.Popen[bytes]) -> int:
    while True:
        pid, status = os.wait()
        if pid == pytest.pid:
            pytest.returncode = os.waitstatus_to_exitcode(status)
            return pytest.returncode


def tell(unsteady: Sequence[Failure]) -> None:
    """Name the unsteady ones, here and in a file."""
    if unsteady:
        lines = "".join(f"{each.test}: {each.reason}\n" for each in unsteady)
        UNSTEADY.parent.mkdir(exist_ok=True)
        UNSTEADY.write_text(lines, encoding="utf-8")
        print(f"\nunsteady, since they passed alone ({UNSTEADY}):\n{lines}", end="")


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(main(sys.argv[1:]))
