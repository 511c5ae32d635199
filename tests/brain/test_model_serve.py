"""`deck model serve`: a real llama.cpp with a model of random weights, asked like any server."""

from __future__ import annotations

import signal
import socket
from base64 import b64encode
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np
import openai
import pytest

from brain.settings import load, settings_path
from robot.commands.schema import DriveCommand, parse_llm
from tests.deck_process import DeckProcess, deck
from tests.served_model import ANSWER, ServedModel, asked, fields_of, served
from tests.tiny_model import DRIVES, RAMBLES, SPEEDS, Habits, write_eyes, write_model
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
            {"type": "image_url", "image_url": {"url": f"data:image/jpeg;base64,{b64encode(_JPEG).decode()}"}},
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


@pytest.mark.parametrize("habits", [RAMBLES, SPEEDS], ids=["rambles", "speeds"])
def test_whatever_a_model_says_has_the_form(tmp_path: Path, habits: Habits) -> None:
    with served(write_model(tmp_path / "wild.gguf", habits)) as wild:
        answers = [asked(wild, seed=seed).message.content for seed in range(20)]
    assert all(fields_of(answer) for answer in answers)
    assert any(fields_of(answer)["commands"] for answer in answers)


def test_a_picture_is_looked_at(model_file: Path, tmp_path: Path) -> None:
    eyes = write_eyes(tmp_path / "eyes.gguf")
    with served(model_file, "--mmproj", str(eyes)) as model, model.client() as client:
        answer = client.chat.completions.create(model=model.name, messages=_PICTURE, response_format=ANSWER)
        assert parse_llm(answer.choices[0].message.content or "").commands
        model.process.said("answered in ")


def test_a_model_without_eyes_says_so(model: ServedModel) -> None:
    with model.client() as client, pytest.raises(openai.APIStatusError, match="mmproj"):
        client.chat.completions.create(model=model.name, messages=_PICTURE)


def test_each_answer_is_told(model_file: Path) -> None:
    with served(model_file) as model:
        asked(model)
        told = model.process.said("answered in ")
        assert " tokens read, " in told
        assert model.process.errors == []


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_it_well_and_frees_the_port(model_file: Path, by: signal.Signals) -> None:
    with served(model_file) as model:
        llama = model.llama()
        assert model.end(by) == 0
        assert not llama.is_running()
        assert model.process.errors == []
    with socket.create_server(("127.0.0.1", model.port)):
        pass


def test_llama_does_not_outlive_a_deck_that_was_killed(model_file: Path) -> None:
    with served(model_file) as model:
        llama = model.llama()
        assert model.end(signal.SIGKILL) == -signal.SIGKILL
        wait_until(lambda: not llama.is_running(), "its end")


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
