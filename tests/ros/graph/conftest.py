"""What several modules need that look at a graph."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.ros.observing import Watcher


@pytest.fixture(scope="module")
def module_watcher(module_domain: int) -> Iterator[Watcher]:
    """An observer in the domain that the module has to itself."""
    watcher = Watcher(module_domain)
    yield watcher
    watcher.close()
