"""The rooms of Deck: the packages whose contracts import-linter checks."""

from __future__ import annotations

from pathlib import Path

from importlinter.application.use_cases import read_user_options
from importlinter.configuration import configure

PYPROJECT = Path(__file__).parents[1] / "pyproject.toml"


def _rooms() -> tuple[str, ...]:
    configure()
    return tuple(read_user_options(str(PYPROJECT)).session_options["root_packages"])


ROOMS = _rooms()
