"""A moving picture over SSH: it keeps to its bytes a second, and keys do not wait behind it."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from tests.e2e.conftest import ROOT, Deck
from tests.e2e.panning_camera import PROFILE, TOPIC
from tests.e2e.terminal import Terminal
from tests.waiting import wait_until

SSH = {"SSH_CONNECTION": "192.0.2.1 50000 192.0.2.2 22"}
LIMIT = 40_000
"""Bytes a second that are promised over SSH."""
LINE = 64_000
AT_ONCE = 30_000
"""What may have been saved, and the picture that goes for it: more than the limit for a moment."""
MOST_AHEAD = 100_000
"""Bytes from a key to its answer: what the line holds, a picture, and the answer itself."""


def test_a_moving_picture_leaves_room_for_keys_on_a_slow_line(deck: Deck, tmp_path: Path) -> None:
    profile = tmp_path / "pan.yaml"
    profile.write_text(PROFILE.format(python=sys.executable, root=ROOT, topic=TOPIC))
    terminal = deck.open(str(profile), "--lang", "en", columns=160, rows=45, env=SSH)
    terminal.wait_for("1/1")
    terminal.press("f3")
    terminal.wait_for(TOPIC)
    terminal.press("/")
    terminal.type("image_raw\r")
    terminal.wait_for(" Hz: limited to 40 kB/s")

    # The terminal takes all at once: it is Deck that holds back.
    begun_s = time.monotonic()
    receive(terminal, 120_000)
    assert time.monotonic() - begun_s > (120_000 - AT_ONCE) / LIMIT

    terminal.bytes_per_s = LINE
    receive(terminal, 160_000)
    for key, answer in (("f1", "Keys of this screen"), ("escape", TOPIC), ("f2", "Camera")):
        assert answer not in terminal.text()
        before = terminal.received
        terminal.press(key)
        terminal.wait_for(answer)
        assert terminal.received - before < MOST_AHEAD


def receive(terminal: Terminal, size: int) -> None:
    """Wait for so many bytes: a picture stands still otherwise."""
    before = terminal.received
    wait_until(lambda: terminal.received - before >= size, f"{size} bytes more", 30)
