"""What Deck says, and does all the same, where the libraries of an extra are not installed."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.slowness import patient

if TYPE_CHECKING:
    from pathlib import Path

WITHOUT = """
import sys
sys.modules.update(dict.fromkeys(("anyio", "mcp", "mcp_types", "openai", "starlette", "uvicorn", "websockets")))
from cli.main import main
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.parametrize(
    ("command", "code", "words"),
    [
        ("mcp --http", 2, "pip install 'deck-robot[agents]'"),
        ("doctor llm", 2, "pip install 'deck-robot[brain]'"),
        ("list", 0, "09-brain"),
    ],
)
def test_a_missing_extra_is_named_where_it_is_needed(command: str, code: int, words: str, tmp_path: Path) -> None:
    settings = tmp_path / "deck" / "llm.yaml"
    settings.parent.mkdir()
    settings.write_text("base_url: http://127.0.0.1:9/v1\nmodel: any\n")
    ended = subprocess.run(
        [sys.executable, "-c", WITHOUT, *command.split()],
        env={"XDG_CONFIG_HOME": str(tmp_path), "HOME": str(tmp_path), "LANG": "C.UTF-8"},
        capture_output=True,
        text=True,
        timeout=patient(60),
        check=False,
    )
    assert ended.returncode == code, ended.stderr
    assert words in ended.stdout + ended.stderr
    assert "Traceback" not in ended.stderr
