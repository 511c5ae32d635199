"""What somebody means who names a session that runs; the rest needs sessions, see tests/ros."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.client.running import find_running
from launcher.errors import NotRunningError


def test_a_link_to_itself_is_no_session(tmp_path: Path) -> None:
    link = tmp_path / "loop.yaml"
    link.symlink_to(link)
    with pytest.raises(NotRunningError):
        find_running(str(link))
