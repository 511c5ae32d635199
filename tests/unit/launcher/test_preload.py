"""Which modules a forked node imports anew: those of Deck, and no others."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from launcher.spawn_server import preload


def test_pythons_own_modules_stay_where_the_environment_is_in_the_checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    assert preload._stamp("launcher.spawn_server.preload") is not None
    monkeypatch.setattr(preload, "INSTALLATION", str(Path(os.__file__).parents[2]))
    assert [name for name in ("os", "importlib", "__main__") if preload._stamp(name)] == []
