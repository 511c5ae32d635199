"""Write locked/: what `make setup` installs, to the version and the hash, for every Python.

Usage: lock.py, run by `make lock`. It asks the package index for the
newest versions that pyproject.toml and interfaces/pyproject.toml allow, and keeps no address of it.
uv resolves for Pythons that are not installed here, which pip does not: where two Pythons need two
versions, a line says for which of them it is.
"""

from __future__ import annotations

import subprocess
import sys
import venv
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # pytest brings it there

ROOT = Path(__file__).resolve().parent.parent
LOCKED = ROOT / "locked"
OLDEST = "3.10"
UV = "uv>=0.9,<1"
BACKENDS = {"deck": ("editables",), "interfaces": ("cmake", "ninja")}
"""What the build backends ask for only once they are asked themselves."""


def main() -> int:
    """Lock the requirements of Deck and those of building the message types."""
    uv = resolver()
    wanted = requirements()
    LOCKED.mkdir(exist_ok=True)
    for name, lines in wanted.items():
        path = LOCKED / f"{name}.txt"
        path.write_text(f"# Written by `make lock`.\n{resolved(uv, lines)}")
        print(path.relative_to(ROOT))
    return 0


def resolver() -> Path:
    """Return uv, in an environment of its own."""
    folder = ROOT / "build" / "lock"
    venv.create(folder, with_pip=True, clear=True)
    subprocess.run([folder / "bin" / "pip", "install", "--quiet", UV], check=True)
    return folder / "bin" / "uv"


def requirements() -> dict[str, list[str]]:
    """Return what is to be locked, by the name of its files."""
    deck = tomllib.loads((ROOT / "pyproject.toml").read_text())
    interfaces = tomllib.loads((ROOT / "interfaces" / "pyproject.toml").read_text())
    extras = deck["project"]["optional-dependencies"]
    wanted = {
        "deck": [
            *deck["project"]["dependencies"],
            *(line for extra in extras.values() for line in extra),
            *deck["build-system"]["requires"],
        ],
        "interfaces": interfaces["build-system"]["requires"],
    }
    return {name: [*lines, *BACKENDS[name]] for name, lines in wanted.items()}


def resolved(uv: Path, lines: list[str]) -> str:
    """Return these requirements and all that they need, pinned, with the hashes of their files."""
    command: list[str | Path] = [
        *(uv, "pip", "compile", "--no-config", "--quiet", "--generate-hashes"),
        *("--no-header", "--no-annotate", "--no-emit-index-url", "--no-emit-find-links"),
        *("--universal", "--python-version", OLDEST, "-"),
    ]
    text = "\n".join(lines)
    done: subprocess.CompletedProcess[str] = subprocess.run(
        command, cwd=ROOT, input=text, stdout=subprocess.PIPE, text=True, check=True
    )
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
