"""A virtual environment with Deck's wheel in it, beside packages of somebody else."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

from hatchling.builders.wheel import WheelBuilder

from tests.rooms import ROOMS

ROOT = Path(__file__).parents[1]
INSIDE = tuple(room for room in ROOMS if room != "deck")
"""The rooms in the package `deck`."""


def build_wheel(folder: Path) -> Path:
    (built,) = WheelBuilder(str(ROOT)).build(directory=str(folder), versions=["standard"])
    return Path(built)


class Installed:
    """Deck as somebody has it who has installed the wheel; the libraries are those of the tests."""

    def __init__(self, folder: Path) -> None:
        environment = folder / "environment"
        venv.create(environment, symlinks=True)
        self.bin = environment / "bin"
        version = f"python{sys.version_info.major}.{sys.version_info.minor}"
        self.site = environment / "lib" / version / "site-packages"
        self._environ = {
            name: value
            for name, value in os.environ.items()
            if name not in ("PYTHONPATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE")
        }
        self._add_libraries()
        self._add_foreign_packages()
        wheel = build_wheel(folder)
        pip = [sys.executable, "-m", "pip", "--python", str(self.bin / "python"), "install"]
        self.said_by(*pip, "--quiet", "--no-deps", "--no-index", str(wheel))

    def _add_libraries(self) -> None:
        # A folder that is named in a .pth file is only a place: the checkout that is named by a
        # .pth file there is none.
        libraries = Path(sysconfig.get_path("purelib"))
        lines = [str(libraries)]
        if (libraries / "ros_wheels_bootstrapper.pth").exists():
            lines.append("import ros_wheels_bootstrapper")
        (self.site / "libraries.pth").write_text("\n".join(lines))

    def _add_foreign_packages(self) -> None:
        for name in INSIDE:
            (self.site / name).mkdir()
            (self.site / name / "__init__.py").write_text(
                f"WHOSE = 'somebody else'\nopen({str(self.imported)!r}, 'a').write(__name__)\n"
            )

    @property
    def imported(self) -> Path:
        """Where the foreign packages tell that they have been imported."""
        return self.site / "imported"

    def said_by(self, *command: str, code: int = 0) -> str:
        """Run a command to its end; return what it has written."""
        done = subprocess.run(
            command,
            cwd=self.bin.parent,
            env=self._environ,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        assert done.returncode == code, done.stdout
        return done.stdout

    def deck(self, *words: str, code: int = 0) -> str:
        """Run the command `deck`."""
        return self.said_by(str(self.bin / "deck"), *words, code=code)

    def python(self, *words: str, code: int = 0) -> str:
        return self.said_by(str(self.bin / "python"), *words, code=code)
