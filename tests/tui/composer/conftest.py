"""What the tests of asking share: a model, and folders of their own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.model_server import KEY, ModelServer
from tests.tui.composer.asking import GOOD, Answers
from tests.tui.recorded_lesson import SESSION


@pytest.fixture
def own_folders(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Settings, budget and caches of nobody else."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("THE_KEY", KEY)
    (tmp_path / "run" / SESSION.run_id).mkdir(parents=True)


@pytest.fixture
def server() -> Iterator[ModelServer]:
    """A model that gives one good answer, again and again."""
    with ModelServer(Answers(GOOD)) as server:
        yield server
