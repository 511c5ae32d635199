"""A hook for hatch: compile the message catalogues before a wheel is built.

An editable install also builds a wheel, so a checkout gets them by `make setup`.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CatalogueHook(BuildHookInterface[Any]):
    """Runs scripts/catalogues.py in the environment of the build, which has babel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        script = Path(self.root) / "scripts" / "catalogues.py"
        subprocess.run([sys.executable, script, "compile"], check=True)
