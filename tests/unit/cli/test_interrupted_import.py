"""An interrupt while a command is imported: the import ends, then the command does not begin."""

from __future__ import annotations

import signal
import sys
from typing import TYPE_CHECKING

import pytest

from cli import main as cli_main

if TYPE_CHECKING:
    from pathlib import Path

COMMAND = """
import signal
signal.raise_signal(signal.SIGINT)
IMPORTED = True

def command(options):
    raise AssertionError("the command began")
"""


def test_it_ends_with_130_once_the_import_is_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "slow_command.py").write_text(COMMAND)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setitem(sys.modules["cli.main"].HANDLERS, "list", ("slow_command", "command"))
    before = signal.getsignal(signal.SIGINT)
    assert cli_main(["list"]) == 130
    assert sys.modules.pop("slow_command").IMPORTED
    assert signal.getsignal(signal.SIGINT) is before
