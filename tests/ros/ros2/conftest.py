"""One known node for all tests of a module, in whose domain their commands are typed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.ros.peer import DISCOVERY
from tests.ros.ros2.world import World

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(scope="module")
def world(module_domain: int) -> Iterator[World]:
    with World(module_domain) as running:
        yield running


@pytest.fixture(autouse=True)
def _in_its_domain(world: World, module_domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    del world
    monkeypatch.setenv("ROS_DOMAIN_ID", str(module_domain))
    for key, value in DISCOVERY.items():
        monkeypatch.setenv(key, value)
