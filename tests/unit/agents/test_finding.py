"""Why agents are told that there is no robot."""

from __future__ import annotations

import asyncio
import contextlib
from pathlib import Path

import pytest

from agents.refusal import RefusedError
from agents.session import SessionFinder
from text.i18n import localized


@pytest.mark.parametrize(("discovery", "told"), [("subnet", True), ("localhost", False)])
async def test_whoever_looks_on_the_network_is_told_where_agents_are_served(
    discovery: str, told: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "runs"))
    finder = SessionFinder(None, None, lambda: None, discovery)
    looking = asyncio.create_task(finder.keep())
    try:
        with pytest.raises(RefusedError) as refusal:
            await finder.session()
    finally:
        looking.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await looking
    said = localized(refusal.value.words)
    assert "nothing runs in the background" in said
    assert ("start deck mcp on it, over SSH" in said) is told
