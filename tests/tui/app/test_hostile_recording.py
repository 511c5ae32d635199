"""A recording whose topics, types, messages and folder mean harm, on the screens of the replay."""

from __future__ import annotations

from pathlib import Path

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer

from tests.hostile_text import EVIL, EVIL_NAME
from tests.tui.looked_through import looked_through
from tests.tui.replayed import BagOpener
from tests.unit.bags import BEGIN_NS, SECOND_NS, store
from tui.session.requests import OpenRequest, ReplayRequest

pytestmark = pytest.mark.nightly

WORDS, LOG = "std_msgs/msg/String", "rcl_interfaces/msg/Log"


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """A second of it, every text hostile."""
    types = store()
    made = types.types
    stamp = made["builtin_interfaces/msg/Time"](sec=BEGIN_NS // SECOND_NS, nanosec=0)
    word = types.serialize_cdr(made[WORDS](data=EVIL), WORDS)
    said = made[LOG](stamp=stamp, level=40, name=EVIL, msg=EVIL, file=EVIL, function=EVIL, line=1)
    line = types.serialize_cdr(said, LOG)
    with Writer(tmp_path / EVIL_NAME, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        topics = [
            (writer.add_connection(name, kind, typestore=types), raw)
            for name, kind, raw in (
                ("/plain", WORDS, word),
                (f"/evil{EVIL}", WORDS, word),
                ("/rosout", LOG, line),
            )
        ]
        for tenth in range(10):
            for connection, raw in topics:
                writer.write(connection, BEGIN_NS + tenth * SECOND_NS // 10, bytes(raw))
    return tmp_path / EVIL_NAME


@pytest.mark.parametrize(
    ("screen", "keys"),
    [
        ("deck", ("f1", "escape", "f9")),
        ("topics", (*("down", "e", "y", "e", "v") * 3, "n", "escape")),
        ("logs", ("l", "down", "escape", "up", "c", "C")),
        ("flow", ("l", "a", "y")),
    ],
)
async def test_no_recording_reaches_the_terminal(
    screen: str, keys: tuple[str, ...], bag: Path
) -> None:
    order = OpenRequest(replay=ReplayRequest(bag))
    async with looked_through(screen, BagOpener(position_s=0.5), order) as stage:
        await stage.press(*keys)
        await stage.app.feed.disconnect()
