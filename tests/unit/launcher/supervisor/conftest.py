"""What every test of a node asks for."""

from __future__ import annotations

import pytest

from tests.unit.launcher.supervisor.fake_session import FakeSession


@pytest.fixture
async def session(monkeypatch: pytest.MonkeyPatch) -> FakeSession:
    made = FakeSession()
    monkeypatch.setattr("launcher.processes.stop.send", made.send)
    return made
