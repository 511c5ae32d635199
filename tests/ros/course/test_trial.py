"""A run of a lesson leaves nothing behind, whatever becomes of its end."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

import course.proof.trial
from course.lessons.lesson import LessonFolder
from course.proof.places import Places
from course.proof.trial import trial
from launcher.client.client import running
from tests.waiting import until

STEP = {"id": "one", "file": "lesson.yaml", "checks": [{"log": "one", "matches": "never"}]}


async def test_a_session_ends_with_its_run_even_if_nobody_waits_for_it(
    tmp_path: Path, ros_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on a busy machine, where the end takes longer than a run waits for."""
    monkeypatch.setattr(course.proof.trial, "PARTING_S", 0)
    places = Places(tmp_path / "run", "hello")
    places.make()
    text = {"nodes": {"one": {"run": "./one.py"}}, "steps": [STEP]}
    for folder in (places.files, tmp_path):
        (folder / "lesson.yaml").write_text(yaml.safe_dump(text))
        (folder / "one.py").write_text("import time\n\ntime.sleep(1000)\n")
    async with trial(LessonFolder(tmp_path), places, seed=1, domain=ros_domain):
        assert [session.domain for session in running()] == [ros_domain]
    await until(lambda: not running(), "the session ends")
