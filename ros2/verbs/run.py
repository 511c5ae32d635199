"""`ros2 run`: become the program of a package, so that signals and the exit code are its own."""

from __future__ import annotations

import argparse
import os
import shlex
import sys
from typing import TYPE_CHECKING

from ros2.elsewhere import PACKAGES
from ros2.packages import CONFIG, NoPackageError, executables, misplaced
from ros2.verb import arg, verb
from text.i18n import localized
from text.sentences import say

if TYPE_CHECKING:
    from pathlib import Path


@verb(
    "run", "Run a package specific executable",
    arg(
        "--prefix",
        help="Prefix command, which should go before the executable. Command must be wrapped in quotes if it "
        "contains spaces (e.g. --prefix 'gdb -ex run --args').",
    ),
    arg("package_name", help="Name of the ROS package"),
    arg("executable_name", help="Name of the executable"),
    arg("argv", nargs=argparse.REMAINDER, help="Pass arbitrary arguments to the executable"),
)  # fmt: skip
def run(args: argparse.Namespace) -> int | str | None:
    """Find the program and become it."""
    try:
        paths = executables(args.package_name)
    except NoPackageError:
        instead = PACKAGES.get(args.package_name, "")
        return f"Package '{args.package_name}' not found{instead and '. '}{instead}"
    fitting = [path for path in paths if path.name == args.executable_name]
    if not fitting:
        beside = misplaced(args.package_name, args.executable_name)
        return "No executable found" + (f". {_configured(beside, args)}" if beside else "")
    if len(fitting) > 1:
        return "\n- ".join(["Multiple executables found:", *map(str, fitting)])
    return _become([*shlex.split(args.prefix or ""), *_program(fitting[0]), *args.argv])


def _configured(beside: Path, args: argparse.Namespace) -> str:
    """Say which file has put a program elsewhere, and what has to stand in it."""
    words = say(
        "{program} was installed into {folder}, and is looked for in {wanted}: beside setup.py, the"
        " file {file} is missing, or has not these lines. Then colcon build again.",
        program=args.executable_name,
        folder=f"{beside.parent}/",
        wanted=f"lib/{args.package_name}/",
        file="setup.cfg",
    )
    return f"{localized(words)}\n{CONFIG.format(name=args.package_name)}".rstrip()


def _program(path: Path) -> list[str]:
    """Return the start of the command line: a Python file without `#!` gets this Python."""
    with path.open("rb") as file:
        bare = file.read(2) != b"#!" and path.suffix == ".py"
    return [sys.executable, str(path)] if bare else [str(path)]


def _become(argv: list[str]) -> str:
    sys.stdout.flush()
    try:
        os.execvp(argv[0], argv)
    except OSError as error:
        return f"{argv[0]}: {error.strerror}"
