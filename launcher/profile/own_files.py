"""What can be seen to be wrong with the learner's own files that a profile runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from launcher.errors import ProfileProblem
from launcher.faults.source import look_at
from launcher.profile.text import shown

if TYPE_CHECKING:
    from launcher.profile.spec import Profile


def faults_of(profile: Profile) -> tuple[ProfileProblem, ...]:
    """Return a problem for each file that does not compile, or imports what is not there."""
    files = {node.own_file: name for name, node in profile.nodes.items() if node.own_file}
    faults = [(name, look_at(file)) for file, name in files.items()]
    return tuple(
        ProfileProblem(
            shown(Path(fault.file)), fault.line, fault.column, f"nodes.{name}", fault.exception, fault.meaning
        )
        for name, fault in faults
        if fault is not None
    )
