"""`deck model serve`: a real llama.cpp with a model of random weights, asked like any server."""

from __future__ import annotations

import signal
import socket
from base64 import b64encode
from typing import TYPE_CHECKING, Any

import cv2
import httpx2
import numpy as np
import openai
import psutil
import pytest

from brain.budget import Ledger
from brain.client import ModelClient
from brain.key import key_of
from brain.ladder import Ladder, Rung
from brain.settings import load, settings_path
from robot.commands.schema import DriveCommand, parse_llm
from tests.deck_process import DeckProcess, deck
from tests.served_model import ANSWER, QUESTION, ServedModel, asked, fields_of, served
from tests.tiny_model import (
    DRIVES,
    RAMBLES,
    SPEEDS,
    TRAINED_CONTEXT,
    Habits,
    write_eyes,
    write_model,
)
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

pytestmark = pytest.mark.nightly


_JPEG = cv2.imencode(".jpg", np.full((48, 64, 3), 128, np.uint8))[1].tobytes()
_PICTURE: Any = [
    {
        "role": "user",
        "content": [
            {"type": "text", "text": "What is there?"},
            {
                "type": "image_url",
                "image_url": {"url": f"data:image/jpeg;base64,{b64encode(_JPEG).decode()}"},
            },
        ],
    }
]


@pytest.fixture(scope="module")
def model_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_model(tmp_path_factory.mktemp("model") / "tiny.gguf", DRIVES)


@pytest.fixture(scope="module")
def model(model_file: Path) -> Iterator[ServedModel]:
    """A server that several tests ask."""
    with served(model_file) as served_model:
        yield served_model


def test_an_answer_in_the_form_of_the_schema_drives(model: ServedModel) -> None:
    choice = asked(model)
    assert choice.finish_reason == "stop"
    commands = parse_llm(choice.message.content).commands
    assert commands
    assert all(isinstance(command, DriveCommand) and command.speed > 0 for command in commands)


def test_an_answer_comes_in_pieces_and_with_its_count(model: ServedModel) -> None:
    pieces, tokens = [], 0
    with model.client() as client:
        for piece in client.chat.completions.create(
            model=model.name,
            messages=QUESTION,
            stream=True,
            stream_options={"include_usage": True},
            response_format=ANSWER,
        ):
            pieces += [choice.delta.content or "" for choice in piece.choices]
            tokens = piece.usage.completion_tokens if piece.usage else tokens
    assert parse_llm("".join(pieces)).commands
    assert len(pieces) > 10
    assert tokens > 10


@pytest.mark.parametrize("habits", [RAMBLES, SPEEDS], ids=["rambles", "speeds"])
def test_whatever_a_model_says_has_the_form(tmp_path: Path, habits: Habits) -> None:
    with served(write_model(tmp_path / "wild.gguf", habits)) as wild:
        answers = [asked(wild, seed=seed).message.content for seed in range(20)]
    assert all(fields_of(answer) for answer in answers)
    assert any(fields_of(answer)["commands"] for answer in answers)


async def test_deck_finds_out_that_it_obeys_a_schema(model: ServedModel, tmp_path: Path) -> None:
    _write_settings(model)
    settings = load()
    assert settings is not None
    async with ModelClient(settings, key_of(settings), Ledger(tmp_path), "test") as client:
        assert await Ladder(client, settings.model, tmp_path).rung() is Rung.STRICT


def test_a_picture_is_looked_at(model_file: Path, tmp_path: Path) -> None:
    eyes = write_eyes(tmp_path / "eyes.gguf")
    with served(model_file, "--mmproj", str(eyes)) as model, model.client() as client:
        answer = client.chat.completions.create(
            model=model.name, messages=_PICTURE, response_format=ANSWER
        )
        assert parse_llm(answer.choices[0].message.content or "").commands
        model.process.said("answered in ")


def test_a_model_without_eyes_says_so(model: ServedModel) -> None:
    with model.client() as client, pytest.raises(openai.APIStatusError, match="mmproj"):
        client.chat.completions.create(model=model.name, messages=_PICTURE)


def test_eyes_of_another_model_are_refused(model_file: Path, tmp_path: Path) -> None:
    tried = deck("model", "serve", str(model_file), "--mmproj", str(model_file), "--port", "0")
    assert tried.process.returncode == 2
    (words,) = tried.errors
    assert words.startswith("llama.cpp cannot use ")
    eyes = write_eyes(tmp_path / "eyes.gguf")
    tried = deck("model", "serve", str(eyes), "--port", "0")
    assert tried.process.returncode == 2
    assert "--mmproj" in tried.errors[0]


def test_each_answer_is_told(model_file: Path) -> None:
    with served(model_file) as model:
        asked(model)
        told = model.process.said("answered in ")
        assert " tokens read, " in told
        assert model.process.errors == []


def test_others_on_this_machine_do_not_see_what_is_asked(model: ServedModel) -> None:
    origin = {"Origin": "http://example.org"}
    answer = httpx2.get(f"{model.base_url}/models", headers=origin)
    assert answer.is_success
    assert not answer.headers.get("access-control-allow-origin")
    assert not httpx2.get(model.base_url.replace("/v1", "/slots")).is_success


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_it_well_and_frees_the_port(model_file: Path, by: signal.Signals) -> None:
    with served(model_file) as model:
        llama = model.llama()
        assert model.end(by) == 0
        assert not llama.is_running()
        assert model.process.errors == []
    with socket.create_server(("127.0.0.1", model.port)):
        pass


def test_ctrl_c_in_a_terminal_is_for_deck(model_file: Path) -> None:
    """It reaches both processes, and Deck ends the other one."""
    with served(model_file) as model:
        model.llama().send_signal(signal.SIGINT)
        assert asked(model).finish_reason == "stop"
        assert model.end() == 0


def test_it_ends_while_it_answers(model_file: Path) -> None:
    with served(model_file) as model, model.client() as client:
        stream = client.chat.completions.create(
            model=model.name,
            messages=[{"role": "user", "content": "Talk."}],
            stream=True,
            extra_body={"ignore_eos": True},
        )
        with stream:
            next(iter(stream))
            assert model.end() == 0


def test_llama_does_not_outlive_a_deck_that_was_killed(model_file: Path) -> None:
    with served(model_file) as model:
        llama = model.llama()
        assert model.end(signal.SIGKILL) == -signal.SIGKILL
        wait_until(lambda: not llama.is_running(), "its end")


@pytest.mark.parametrize(
    ("by", "told"),
    [
        (signal.SIGKILL, "llama.cpp was killed, most likely for want of memory"),
        (signal.SIGABRT, "llama.cpp has broken off with {path}: SIGABRT"),
    ],
)
def test_the_end_of_llama_is_told(model_file: Path, by: signal.Signals, told: str) -> None:
    with served(model_file) as model:
        model.llama().send_signal(by)
        assert model.process.finish() == 1
        assert model.process.errors[0].startswith(told.format(path=model_file))
        assert len(model.process.errors) == 1


def test_the_lines_that_it_prints_are_settings(tmp_path: Path) -> None:
    path = write_model(tmp_path / "да 'true' $(x).gguf")
    with served(path) as model:
        _write_settings(model)
        settings = load()
        assert settings is not None
        assert (settings.base_url, settings.model) == (model.base_url, model.name)
        again = DeckProcess("model", "serve", str(path), "--port", "0")
        try:
            again.said("for Deck to ask it, write into ")
        finally:
            again.close()
    same = DeckProcess("model", "serve", str(path), "--port", str(model.port))
    try:
        same.said("Deck's settings already name it")
    finally:
        same.close()


def _write_settings(model: ServedModel) -> None:
    model.process.said("or, for what is started in one terminal:")
    lines = [line for line in model.process.lines if line.startswith(("  base_url:", "  model:"))]
    settings_path().parent.mkdir(parents=True, exist_ok=True)
    settings_path().write_text("\n".join(line.strip() for line in lines), encoding="utf-8")


def test_a_port_in_use_is_told(model: ServedModel, model_file: Path) -> None:
    other = deck("model", "serve", str(model_file), "--port", str(model.port))
    assert other.process.returncode == 2
    assert other.errors == [f"port {model.port} is in use: choose another by --port"]


def test_open_to_the_network_only_with_a_warning(model_file: Path) -> None:
    with served(model_file, "--host", "0.0.0.0") as model:
        model.process.said("export DECK_LLM_BASE_URL=")
        (warning,) = wait_until(lambda: model.process.errors, "a warning")
        assert (
            f"WARNING: whoever reaches {socket.gethostname()} on the network can use it" in warning
        )
        assert model.base_url.startswith(f"http://{socket.gethostname()}:")
        assert {each.laddr.ip for each in _listening(model)} == {"0.0.0.0"}


def test_this_machine_only_by_default(model: ServedModel) -> None:
    assert {each.laddr.ip for each in _listening(model)} == {"127.0.0.1"}
    assert model.process.errors == []


def _listening(model: ServedModel) -> list[Any]:
    sockets = model.llama().net_connections("tcp")
    return [each for each in sockets if each.status == psutil.CONN_LISTEN]


def test_the_robot_comes_first(model: ServedModel) -> None:
    # Who runs the tests may have given way to all others already.
    ours = psutil.Process(model.process.process.pid).nice()
    assert model.llama().nice() > min(ours, 18)


def test_the_context_is_what_was_asked_for_and_trained(model_file: Path) -> None:
    with served(model_file, "--context", "512") as model:
        assert model.context == 512
        with model.client() as client:
            (found,) = client.models.list().data
        assert found.id == "tiny"
        assert found.model_extra
        assert found.model_extra["meta"]["n_ctx"] == 512
    more = deck("model", "serve", str(model_file), "--context", str(TRAINED_CONTEXT + 1))
    assert more.process.returncode == 2
    assert more.errors == ["tiny was trained for 4096 tokens at once: --context 4096 at most"]


def test_the_log_of_llama_is_shown_on_demand(model_file: Path) -> None:
    with served(model_file, "--verbose") as model:
        wait_until(
            lambda: any("listening on http://" in line for line in model.process.errors), "its log"
        )


def _cut(content: bytes) -> bytes:
    return content[:-1000]


def _cut_in_the_header(content: bytes) -> bytes:
    return content[:5000]


def _magic_only(content: bytes) -> bytes:
    return content[:4]


def _unknown_architecture(content: bytes) -> bytes:
    return content.replace(b"llama", b"xlama", 1)


def _missing_weights(content: bytes) -> bytes:
    return content.replace(b"blk.0.attn_q.weight", b"blk.0.attn_x.weight")


def _no_numbers(content: bytes) -> bytes:
    return content[:-100_000] + b"\xff" * 100_000


def _newer(content: bytes) -> bytes:
    return content[:4] + (9).to_bytes(4, "little") + content[8:]


def _huge(content: bytes) -> bytes:
    return content[:8] + (1 << 60).to_bytes(8, "little") + content[16:]


def _broken_template(content: bytes) -> bytes:
    return content.replace(b"{%- if tools %}", b"{%- if tools  }")


@pytest.mark.parametrize(
    ("damaged", "told"),
    [
        (_cut, "data is not within the file bounds, model is corrupted or incomplete"),
        (_cut_in_the_header, "exceeds remaining file size"),
        (_magic_only, "failed to read header"),
        (_unknown_architecture, "unknown model architecture: 'xlama'"),
        (_missing_weights, "tensor 'blk.0.attn_q.weight' not found"),
        (_no_numbers, "has invalid data"),
        (_newer, "this GGUF file is version 9"),
        (_huge, "number of tensors is"),
        (_broken_template, "Parser Error"),
    ],
)
def test_a_damaged_file_is_refused_in_one_sentence(
    model_file: Path, tmp_path: Path, damaged: Callable[[bytes], bytes], told: str
) -> None:
    path = tmp_path / "damaged.gguf"
    path.write_bytes(damaged(model_file.read_bytes()))
    tried = deck("model", "serve", str(path), "--port", "0")
    assert tried.process.returncode == 2
    (words,) = tried.errors
    assert words.startswith(f"llama.cpp cannot use {path} (")
    assert told in words
    assert words.endswith("): download it again, or take another model")
