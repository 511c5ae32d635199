"""The ledger: one for all processes of a session."""

from __future__ import annotations

import multiprocessing
from typing import TYPE_CHECKING

import pytest

from brain.budget import Ledger, TokenUsage
from brain.faults import ModelError
from brain.settings import BudgetSettings, PriceSettings
from text.run_path import MODEL_USAGE, run_folder

if TYPE_CHECKING:
    from pathlib import Path

BUDGET = BudgetSettings(calls_per_minute=40)
USAGE = TokenUsage("m", 100, 20, 0.1, 0.5)


def _calls(folder: Path, count: int) -> None:
    ledger = Ledger(folder)
    for _ in range(count):
        ledger.begin("node", BUDGET)
        ledger.end("node", USAGE)


def test_processes_share_a_budget(tmp_path: Path) -> None:
    """Four processes at once: no call is lost, and the limit is that of all together."""
    spawn = multiprocessing.get_context("spawn")
    processes = [spawn.Process(target=_calls, args=(tmp_path, 10)) for _ in range(4)]
    for process in processes:
        process.start()
    for process in processes:
        process.join()
        assert process.exitcode == 0
    totals = Ledger(tmp_path).totals()
    assert (totals.calls, totals.calls_last_minute, totals.tokens) == (40, 40, 40 * 120)
    with pytest.raises(ModelError, match="40 calls a minute is used up"):
        Ledger(tmp_path).begin("node", BUDGET)
    assert (tmp_path / MODEL_USAGE).stat().st_mode & 0o077 == 0


def test_a_line_that_was_cut_short_does_no_harm(tmp_path: Path) -> None:
    ledger = Ledger(tmp_path)
    ledger.begin("node", BUDGET)
    with (tmp_path / MODEL_USAGE).open("a") as file:
        file.write('{"begun_s": 17\n[]\nnull\n')
    ledger.end("node", USAGE)
    assert (ledger.totals().calls, ledger.totals().tokens) == (1, 120)


def test_a_folder_that_is_gone_is_told(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="cannot be written"):
        Ledger(tmp_path / "gone").begin("node", BUDGET)


def test_the_cost_is_by_the_users_prices() -> None:
    prices = PriceSettings(input_per_million=2.0, output_per_million=10.0)
    assert USAGE.cost(prices) == pytest.approx(0.0004)
    assert USAGE.cost(None) is None


def test_a_node_finds_the_folder_of_its_run(tmp_path: Path) -> None:
    environ = {"DECK_RUN_DIR": str(tmp_path), "DECK_RUN_ID": "run-1"}
    assert run_folder(environ) is None
    (tmp_path / "run-1").mkdir()
    assert run_folder(environ) == tmp_path / "run-1"
    assert run_folder({}) is None
