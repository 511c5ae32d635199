"""Whether the tests notice what is broken: `python -m tests.mutants [NAME …]`.

Each patch beside this file breaks the product in one place. It is applied to this checkout, which
must be clean, the test named in its first line (`# noticed by FILE::TEST`) is run, and it is taken
back. Without names all are tried. The exit code is 1 if one goes unnoticed or no longer applies.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
NOTICED_BY = "# noticed by "
_SOME_FAILED = 1
"""The exit code of pytest."""


def main(names: list[str]) -> int:
    """Try them; say of each what has come of it."""
    if _git("status", "--porcelain").stdout:
        sys.stderr.write("commit or stash first: this changes the checkout for a time\n")
        return 2
    patches = [HERE / f"{name}.patch" for name in names] or sorted(HERE.glob("*.patch"))
    said = {patch.stem: tried(patch) for patch in patches}
    noticed = sum(word == "noticed" for word in said.values())
    print(f"{noticed} of {len(said)} noticed")
    return 0 if noticed == len(said) else 1


def tried(patch: Path) -> str:
    """Break, test, mend; return `noticed`, `unnoticed`, or why it could not be tried."""
    test = patch.read_text(encoding="utf-8").splitlines()[0].removeprefix(NOTICED_BY)
    if _git("apply", str(patch)).returncode:
        word = "does not apply"
    else:
        try:
            pytest = [sys.executable, "-m", "pytest", "-q", "-x", "-n", "0", test]
            code = subprocess.run(pytest, cwd=ROOT, capture_output=True, check=False).returncode
        finally:
            _git("apply", "--reverse", str(patch))
        word = {_SOME_FAILED: "noticed", 0: "unnoticed"}.get(code, f"pytest: {code}")
    print(f"{patch.stem}: {word} ({test})", flush=True)
    return word


def _git(*arguments: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=False)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
