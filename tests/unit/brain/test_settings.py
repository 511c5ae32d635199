"""Settings, key and budget of a model: each mistake with its place, the key never shown."""

from __future__ import annotations

import multiprocessing
import os
from pathlib import Path

import pytest

from brain.budget import Ledger, TokenUsage
from brain.faults import ModelError
from brain.key import key_of
from brain.settings import BudgetSettings, ModelSettings, PriceSettings, load
from tests.model_server import KEY
from text.run_path import MODEL_USAGE

GOOD = "base_url: http://127.0.0.1:8080/v1/\nmodel: qwen3-1.7b\n"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "llm.yaml"


def test_without_a_file_and_variables_there_are_no_settings(path: Path) -> None:
    assert load(path, {}) is None
    path.write_text("# nothing yet\n")
    assert load(path, {}) is None


def test_the_file_is_read_and_variables_go_before_it(path: Path) -> None:
    path.write_text(GOOD + "budget: {calls_per_minute: 3}\nprices: {input_per_million: 1, output_per_million: 2.5}\n")
    settings = load(path, {"DECK_LLM_MODEL": "other"})
    assert settings is not None
    assert (settings.base_url, settings.model) == ("http://127.0.0.1:8080/v1", "other")
    assert settings.budget.calls_per_minute == 3
    assert settings.prices is not None
    assert settings.prices.output_per_million == 2.5
    alone = load(path.with_name("none"), {"DECK_LLM_BASE_URL": "https://x/v1", "DECK_LLM_MODEL": "m"})
    assert alone is not None
    assert alone.base_url == "https://x/v1"


@pytest.mark.parametrize(
    ("text", "words", "fix"),
    [
        ("model: m\n", ":1:1: base_url: is missing", "base_url: http"),
        (GOOD + "modle: x\n", ":3:1: modle: there is no such setting", "did you mean model?"),
        (GOOD + f"key: {KEY}\n", ":3:1: key: a key does not belong in this file", "key_env"),
        ("base_url: localhost\nmodel: m\n", ":1:11: base_url: expected an address", "http"),
        ("base_url: http://u:p@h/v1\nmodel: m\n", "an address must hold no key", ""),
        (GOOD + "timeout_s: soon\n", ":3:12: timeout_s: expected a number", ""),
        (GOOD + "timeout_s: -1\n", ":3:12: timeout_s: is out of range", ""),
        (GOOD + "budget: 7\n", ":3:9: budget: expected settings", ""),
        (GOOD + "budget: {calls: 7}\n", "budget.calls: there is no such setting", ""),
        ("base_url: [\n", "llm.yaml:", ""),
        ("- a\n", "expected `name: value`, found a list", ""),
    ],
)
def test_a_mistake_is_named_by_its_place(path: Path, text: str, words: str, fix: str) -> None:
    path.write_text(text)
    with pytest.raises(ModelError) as raised:
        load(path, {})
    assert str(path) in str(raised.value)
    assert words in str(raised.value)
    assert fix in raised.value.fix
    assert KEY not in f"{raised.value} {raised.value.fix}"


def settings(**fields: str) -> ModelSettings:
    return ModelSettings(base_url="http://h/v1", model="m", **fields)  # type: ignore[arg-type]


def test_the_key_comes_from_where_the_settings_say(tmp_path: Path) -> None:
    file = tmp_path / "key"
    file.write_text(f"{KEY}\n")
    file.chmod(0o600)
    environ = {"MINE": KEY, "DECK_LLM_KEY": "sk-other"}
    assert key_of(settings(key_env="MINE"), environ).reveal() == KEY
    assert key_of(settings(key_file=str(file)), environ).reveal() == KEY
    assert key_of(settings(), environ).reveal() == "sk-other"
    assert not key_of(settings(), {})


def test_a_key_that_others_can_read_is_not_used(tmp_path: Path) -> None:
    file = tmp_path / "key"
    file.write_text(KEY)
    for mode in (0o644, 0o640, 0o604):
        file.chmod(mode)
        with pytest.raises(ModelError, match="others may read the key") as raised:
            key_of(settings(key_file=str(file)), {})
        assert raised.value.fix == f"chmod 600 {file}"


@pytest.mark.parametrize("text", ["", "two words", "a\nb", "ключ", "x" * 5000])
def test_what_is_no_key_is_not_shown(tmp_path: Path, text: str) -> None:
    file = tmp_path / "key"
    file.write_text(text)
    os.chmod(file, 0o600)  # noqa: PTH101
    with pytest.raises(ModelError, match="does not hold a key") as raised:
        key_of(settings(key_file=str(file)), {})
    assert not text or text not in str(raised.value)


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


def test_the_cost_is_by_the_users_prices() -> None:
    prices = PriceSettings(input_per_million=2.0, output_per_million=10.0)
    assert USAGE.cost(prices) == pytest.approx(0.0004)
    assert USAGE.cost(None) is None
