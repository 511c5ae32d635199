"""Write locked/: the versions and hashes that `make setup` installs, for every Python.

Usage: lock.py, run by `make lock`. It asks the package index for the newest versions that
pyproject.toml and interfaces/pyproject.toml allow, and does not record the index's address. Unlike
pip, uv resolves for Pythons that are not installed here: where two Pythons need different versions,
each line says which Pythons it is for.
"""

from __future__ import annotations

import re
import subprocess
import sys
import venv
from pathlib import Path
from typing import TYPE_CHECKING

# Run by its path: modules beside it have bare names.
from distro import EXTRAS, for_distro

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # pytest depends on it there

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parent.parent
LOCKED = ROOT / "locked"
OLDEST = "3.10"
UV = "uv>=0.9,<1"
BACKENDS = {"deck": ("editables",), "interfaces": ("cmake", "ninja")}
"""Requirements that build backends only state when they are run."""
APART = ("docs", "view")
"""Extras with a file of their own each, to be installed after `deck.txt`: most need neither."""


def main() -> int:
    """Lock the requirements of Deck and of building the message types."""
    uv = resolver()
    wanted = requirements()
    LOCKED.mkdir(exist_ok=True)
    found = {name: resolved(uv, lines) for name, lines in wanted.items()}
    for name in (*APART, *map("ros-{}".format, EXTRAS)):
        found[name] = beyond(found["deck"], found[name])
    for name, text in found.items():
        path = LOCKED / f"{name}.txt"
        path.write_text(f"# Written by `make lock`.\n{text}")
        print(path.relative_to(ROOT))
    return 0


def resolver() -> Path:
    """Return uv, installed in its own environment."""
    folder = ROOT / "build" / "lock"
    venv.create(folder, with_pip=True, clear=True)
    subprocess.run([folder / "bin" / "pip", "install", "--quiet", UV], check=True)
    return folder / "bin" / "uv"


def requirements() -> dict[str, list[str]]:
    """Return the requirements to lock, by the name of the file they go into."""
    deck = tomllib.loads((ROOT / "pyproject.toml").read_text())
    interfaces = tomllib.loads((ROOT / "interfaces" / "pyproject.toml").read_text())
    extras = deck["project"]["optional-dependencies"]
    apart = {*APART, *EXTRAS.values()}
    of_all = [
        *deck["project"]["dependencies"],
        *(line for name, extra in extras.items() if name not in apart for line in extra),
        *deck["build-system"]["requires"],
        *BACKENDS["deck"],
    ]
    build = [*interfaces["build-system"]["requires"], *BACKENDS["interfaces"]]
    return {
        "deck": of_all,
        # Together, so that what both need has one version.
        **{extra: [*of_all, *extras[extra]] for extra in APART},
        **{f"ros-{name}": [*of_all, *extras[extra]] for name, extra in EXTRAS.items()},
        **{f"interfaces-{name}": list(filter(None, (for_distro(line, name) for line in build))) for name in EXTRAS},
    }


def beyond(base: str, whole: str) -> str:
    """Return the pinned packages of `whole` that `base` does not have.

    Raises ValueError if `base` has one of them in another version.
    """
    already = dict(_pinned(base))
    more = {line: text for line, text in _pinned(whole) if line not in already}
    # The same version for more machines is no clash.
    versions = {line.partition(" ;")[0] for line in already}
    names = {version.partition("==")[0] for version in versions}
    others = {line.partition(" ;")[0] for line in more} - versions
    if clashes := [version for version in others if version.partition("==")[0] in names]:
        raise ValueError(f"not as in deck.txt: {', '.join(clashes)}")
    return "".join(more.values())


def _pinned(text: str) -> Iterator[tuple[str, str]]:
    """Yield each requirement, `name==version ; marker`, and its lines with the hashes."""
    for entry in re.findall(r"^\S.*\n(?:[ ].*\n)*", text, re.MULTILINE):
        yield entry.partition("\\")[0].strip(), entry


def resolved(uv: Path, lines: list[str]) -> str:
    """Return these requirements and their dependencies, pinned, with the hashes of their files."""
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
