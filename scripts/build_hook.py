"""What hatch does before it packs a wheel: compile the message catalogues.

An editable install is a wheel too, so a checkout gets them by `make setup`.
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
        """Compile what is stale."""
        script = Path(self.root) / "scripts" / "catalogues.py"
        subprocess.run([sys.executable, script, "compile"], check=True)
