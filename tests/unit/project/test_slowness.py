"""Deadlines of tests grow with the slowness of the machine."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.slowness import FILE, patient
from tests.waiting import wait_until


@pytest.mark.parametrize(("told", "expected_s"), [("3.00", 6.0), ("0.40", 2.0), ("", 2.0), (None, 2.0)])
def test_a_deadline_is_multiplied_and_never_cut(
    told: str | None, expected_s: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "slowness"
    if told is not None:
        path.write_text(told, encoding="ascii")
    monkeypatch.setenv(FILE, str(path))
    assert patient(2.0) == expected_s


def test_this_run_has_measured_its_machine() -> None:
    assert float(Path(os.environ[FILE]).read_text(encoding="ascii")) > 0


def test_whoever_waits_has_that_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "slowness"
    path.write_text("3.00", encoding="ascii")
    monkeypatch.setenv(FILE, str(path))
    with pytest.raises(pytest.fail.Exception, match=r"not within 0\.03 s"):
        wait_until(lambda: False, "anything", within_s=0.01)
