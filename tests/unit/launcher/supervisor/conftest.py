"""What every test of a node asks for."""

from __future__ import annotations

import pytest

from tests.unit.launcher.supervisor.fake_session import FakeSession


@pytest.fixture
async def session() -> FakeSession:
    return FakeSession()
