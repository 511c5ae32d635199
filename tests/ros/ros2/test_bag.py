"""`ros2 bag` as a program: it ends on a signal without a word of Python's."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.ros.peer import DISCOVERY, ROOT
from tests.unit.bags import write_bag


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_playing_ends_in_order_on_a_signal(ros_domain: int, tmp_path: Path, number: signal.Signals) -> None:
    bag = write_bag(tmp_path / "bag")
    with subprocess.Popen(
        [sys.executable, "-m", "ros2", "bag", "play", str(bag), "--loop"],
        cwd=ROOT,
        env={**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(ros_domain)},
        stderr=subprocess.PIPE,
        text=True,
    ) as play:
        assert play.stderr is not None
        assert any("Set rate to 1" in line for line in play.stderr)
        play.send_signal(number)
        _out, err = play.communicate(timeout=60)
    assert (play.returncode, err) == (0, "")
