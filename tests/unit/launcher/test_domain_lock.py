"""Supervisors of one user settle in a domain one after the other, and leave nothing behind."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import pytest

from launcher.runs import record as supervisor_record
from launcher.runs.record import exclusively, lock_path

ROOT = Path(__file__).resolve().parents[3]
DOMAIN = 42


def test_where_somebody_else_has_planted_the_lock_starts_still_wait_for_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    planted = tmp_path / "planted"
    planted.mkdir()
    runs = tmp_path / "runs"
    runs.mkdir()
    monkeypatch.setattr(supervisor_record, "lock_path", lambda: planted)
    order: list[str] = []

    def second() -> None:
        with exclusively(runs, DOMAIN):
            order.append("second")

    with exclusively(runs, DOMAIN):
        waiting = threading.Thread(target=second)
        waiting.start()
        waiting.join(timeout=0.2)
        order.append("first")
    waiting.join(timeout=30)
    assert order == ["first", "second"]
    assert list(runs.iterdir()) == []


@pytest.mark.machine("namespaces")
def test_who_is_root_in_a_namespace_of_his_own_takes_no_roots_lock() -> None:
    """Else an ordinary user's file would lie where root's Deck looks for its own."""
    shown = "from launcher.runs.record import lock_path; print(lock_path())"
    inside = ("unshare", "--user", "--map-user=4321", sys.executable, "-c", shown)
    done = subprocess.run(inside, cwd=ROOT, capture_output=True, text=True, check=True, timeout=50)
    assert done.stdout.strip() == str(lock_path())
