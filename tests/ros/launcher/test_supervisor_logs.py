"""Logs of real nodes: no flood delays anybody, and no text is more than text."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from launcher.status import NodeState
from tests.ros.supervised import Launch, script, until_state
from tests.waiting import until

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient

pytestmark = pytest.mark.nightly


def transport_of(client: SupervisorClient) -> asyncio.ReadTransport:
    """The connection that a client reads, which can be told to wait."""
    reader: Any = client._reader
    transport: asyncio.ReadTransport = reader._transport
    return transport


async def test_a_node_whose_output_nobody_reads_is_never_blocked(start: Launch) -> None:
    """Not even by a client that has stopped reading."""
    text = """
        import sys
        for i in range(200_000): print("x" * 80)
        print("all written", file=sys.stderr)
    """
    client = await start({"node": {"exec": script(text)}})
    transport_of(client).pause_reading()
    log = Path(client.session.log_dir) / "node.log"
    await until(lambda: log.exists() and b"all written" in log.read_bytes(), "the end of it")
    transport_of(client).resume_reading()
    await until_state(client, "node", NodeState.EXITED)
