"""`deck doctor llm` asks a real server, and says what came of it; the key is never shown."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from brain.faults import FaultKind, ModelError
from brain.ladder import Rung
from brain.settings import ModelSettings
from cli import main
from cli.doctor.model import ModelFacts, diagnose
from tests.model_server import KEY, ModelServer, obeys
from text.sentences import say

if TYPE_CHECKING:
    from pathlib import Path

HELLO = json.dumps({"thought": "a test", "commands": [], "say": "Hello!"})


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user's own folders, without settings."""
    for name in ("XDG_CONFIG_HOME", "XDG_CACHE_HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    (tmp_path / "deck").mkdir()
    return tmp_path / "deck"


def set_up(home: Path, server: ModelServer) -> None:
    (home / "key").write_text(KEY)
    (home / "key").chmod(0o600)
    (home / "llm.yaml").write_text(f"base_url: {server.url}\nmodel: m-1\nkey_file: {home}/key\n")


@pytest.mark.parametrize("rung", [Rung.STRICT, Rung.TOOL])
def test_a_model_that_answers(home: Path, capsys: pytest.CaptureFixture[str], rung: Rung) -> None:
    with ModelServer(obeys(HELLO, rung)) as server:
        set_up(home, server)
        assert main(["doctor", "llm"]) == 0
        again = len(server.exchanges)
        main(["doctor", "llm"])
        assert len(server.exchanges) == 2 * again, "the doctor finds out anew each time"
    said = capsys.readouterr().out
    assert f"m-1 at {server.url}" in said
    assert f"answers as {rung.value}" in said
    assert "first token after" in said
    assert f"{again} requests" in said
    assert KEY not in said


def test_a_model_that_does_not(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit code 1, the reason and the mend; also for programs."""
    with ModelServer(lambda exchange: exchange.fails(401, KEY)) as server:
        set_up(home, server)
        assert main(["doctor", "llm", "--json"]) == 1
    output = capsys.readouterr().out
    found = {each["key"]: each for each in json.loads(output)}
    assert found["llm.answer"]["text"] == "the server does not take the key (401)"
    assert found["llm.answer"]["mend"] == "key_env or key_file in llm.yaml"
    assert KEY not in output


def test_settings_that_cannot_be_used(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """None, and wrong ones: exit code 2, and where the mistake is."""
    assert main(["doctor", "llm"]) == 2
    assert "no language model is set up\ndocs/models.md" in capsys.readouterr().err
    (home / "llm.yaml").write_text("base_url: x\nmodel: y\n")
    assert main(["doctor", "llm"]) == 2
    assert f"{home}/llm.yaml:1:11: base_url: expected an address" in capsys.readouterr().err


def test_the_doctor_tells_what_is_set_up_without_asking() -> None:
    settings = ModelSettings(base_url="http://h/v1", model="m")
    (found,) = diagnose(ModelFacts(settings))
    assert "m at http://h/v1" in found.text
    (found,) = diagnose(ModelFacts())
    assert "none is set up" in found.text
    (found,) = diagnose(
        ModelFacts(fault=ModelError(FaultKind.SETTINGS, say("wrong"), say("write it anew")))
    )
    assert (found.level, found.text, found.fix) == (
        "warn",
        "language model: wrong",
        "write it anew",
    )
