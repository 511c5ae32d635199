"""The audit file and the token: private, and unharmed by what agents write."""

from __future__ import annotations

import json
import stat
from pathlib import Path

import pytest

from agents.audit import MAX_ARGUMENTS, Audit
from agents.token import own_token, token_path
from launcher.errors import UsageError
from tests.hostile_text import WORST


def test_a_call_is_a_line_of_json(tmp_path: Path) -> None:
    audit = Audit(str(tmp_path))
    audit.write("claude", "say", {"text": WORST}, "done", 0.25)
    audit.write("claude", "echo", {"topic": "x" * 100_000}, "refused", 0.1)
    first, second = audit.path.read_text("utf-8").splitlines()
    assert first.isprintable()
    assert json.loads(first)["arguments"] == {"text": WORST}
    assert {**json.loads(first), "time": 0} == {
        "time": 0,
        "client": "claude",
        "tool": "say",
        "arguments": {"text": WORST},
        "outcome": "done",
        "seconds": 0.25,
    }
    assert len(second) < MAX_ARGUMENTS + 200
    assert stat.S_IMODE(audit.path.stat().st_mode) == 0o600


def test_without_a_folder_it_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="No such file"):
        Audit(str(tmp_path / "gone")).write("a", "look", {}, "done", 0.0)


@pytest.fixture(autouse=True)
def _own_config(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))


def test_the_token_is_made_once_and_is_private() -> None:
    token = own_token()
    assert len(token) >= 32
    assert own_token() == token
    assert stat.S_IMODE(token_path().stat().st_mode) == 0o600


def test_a_token_that_others_can_read_is_refused() -> None:
    own_token()
    token_path().chmod(0o644)
    with pytest.raises(UsageError, match="can be read by others"):
        own_token()


def test_a_link_or_an_empty_file_is_no_token(tmp_path: Path) -> None:
    token = own_token()
    path = token_path()
    path.write_text("short\n")
    with pytest.raises(UsageError, match="holds no token"):
        own_token()
    path.unlink()
    (tmp_path / "elsewhere").write_text(token)
    path.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(UsageError):
        own_token()
