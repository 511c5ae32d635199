"""The environment in which a learner's nodes are judged: no secrets, and places of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.run_path import OWN_RUN_DIR

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

KEPT = (
    "HOME", "LANG", "LANGUAGE", "LOGNAME", "PATH", "SHELL", "TERM", "TZ", "USER", "VIRTUAL_ENV",
    "XDG_DATA_HOME", "XDG_DATA_DIRS",
)  # fmt: skip
KEPT_BEGINNINGS = (
    "AMENT_", "CMAKE_PREFIX_", "COLCON_", "CONDA_", "FASTDDS_", "FASTRTPS_", "LC_", "LD_",
    "MALLOC_", "OMP_", "OPENBLAS_", "PIXI_", "PYTHON", "RMW_", "ROS_", "SKIP_DEFAULT_XML_FILE",
)  # fmt: skip
"""What nodes need to find Python and ROS; the token of a CI job is not among it."""
LEFT_OUT = ("PYTHONPYCACHEPREFIX", "ROS_DOMAIN_ID", "ROS_STATIC_PEERS")


def own_places(place: Path) -> dict[str, Path]:
    """Return the folders of the judge and of Deck's nodes, by the variables that say so."""
    own = place / "own"
    return {"DECK_STATE_DIR": own / "state", "ROS_LOG_DIR": own / "ros", "TMPDIR": own / "tmp"}


def environment_of(place: Path, environ: Mapping[str, str]) -> dict[str, str]:
    """Return the environment for one grading, whose files are all in this place.

    The learner's nodes have some of it replaced, see `course.proof.places`.
    """
    own = own_places(place)
    kept = {
        name: value
        for name, value in environ.items()
        if name not in LEFT_OUT and (name in KEPT or name.startswith(KEPT_BEGINNINGS))
    }
    return {
        **kept,
        OWN_RUN_DIR: str(place / "run"),
        "DECK_LOG_DIR": str(place / "logs"),
        **{variable: str(folder) for variable, folder in own.items()},
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_THREAD_TIMEOUT": "4",
    }
