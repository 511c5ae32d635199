"""The key to a server: after a whole session it is in no log, no recording, no file of Deck's."""

from __future__ import annotations

import json
import re
import signal
from typing import TYPE_CHECKING

import pytest
from std_msgs.msg import ByteMultiArray

from tests.deck_process import DeckProcess, deck
from tests.model_server import KEY, ModelServer, obeys
from tests.ros.nodes.test_brain import text, voice
from tests.ros.peer import Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from tests.model_server import Exchange

pytestmark = pytest.mark.nightly

GO = json.dumps({"thought": "t", "commands": [], "say": "Here I am."})
HOLDERS = ("a variable", "a file")


def chatters(exchange: Exchange) -> None:
    """Repeat the key in the complaint, as some servers do."""
    exchange.fails(500, json.dumps({"error": {"message": f"bad key {KEY} for {KEY}"}}))


@pytest.mark.parametrize("holder", HOLDERS)
def test_the_key_is_nowhere_to_be_read(
    ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, holder: str
) -> None:
    """Answers, failures and a record of every topic; then all files, and what was printed."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    config = tmp_path / "config" / "deck"
    config.mkdir(parents=True, exist_ok=True)
    kept = tmp_path.parent / f"{tmp_path.name}-key"
    kept.write_text(KEY)
    kept.chmod(0o600)
    with ModelServer(obeys(GO)) as server:
        given = {"base_url": server.url, "model": "m"}
        if holder == "a variable":
            monkeypatch.setenv("DECK_LLM_KEY", KEY)
        else:
            given["key_file"] = str(kept)
        (config / "llm.yaml").write_text(json.dumps(given))
        up = deck("up", "09-brain", "--set", "audio.period=3600.0")
        try:
            assert up.process.returncode == 0, up.errors
            record = DeckProcess("record", "-o", str(tmp_path / "bag"))
            wait_until(lambda: _recorded(record) > 50, "messages in the record")
            _talk(server, ros_domain)
            record.signal(signal.SIGINT)
            assert record.finish() == 0, (record.errors, record.lines[-5:])
            listed = deck("ps", "--json").lines + deck("logs").lines
        finally:
            deck("down")
        assert server.exchanges[-1].headers["authorization"] == f"Bearer {KEY}"
    assert any("the server failed (500): bad key *** for ***" in line for line in listed)
    printed = "\n".join([*listed, *up.lines, *up.errors, *record.lines, *record.errors])
    assert KEY not in printed
    files = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert any(path.suffix == ".mcap" for path in files)
    assert [path for path in files if KEY.encode() in path.read_bytes()] == []


def _recorded(record: DeckProcess) -> int:
    """Return how many messages it has told of."""
    told = [int(count) for line in record.lines for count in re.findall(r"(\d+) messages", line)]
    return max(told, default=0)


def _talk(server: ModelServer, domain: int) -> None:
    """Have it answer once, and fail once."""
    with Peer(domain) as peer:
        spoken = peer.hear("/audio/speaker_raw", ByteMultiArray)
        for script, reply in ((obeys(GO), "Here I am"), (chatters, "cannot think")):
            server.script = script

            def answered(reply: str = reply) -> bool:
                peer.say("/audio/mic_raw", voice(b"what do you see?"))
                return comes(lambda: any(reply in text(each) for each in spoken), within_s=3.0)

            wait_until(answered, reply)
