"""`deck model serve` before llama.cpp gets the file: what it refuses, and in which words."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from brain.serving.model_file import examine
from cli import main
from tests.tiny_model import TRAINED_CONTEXT, write_model


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert main(["model", "serve", *words]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    return said.err.strip()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "the following arguments are required: FILE"),
        (["--threads", "2", "nowhere.gguf", "--verbose"], "there is no file nowhere.gguf"),
        (["nowhere.gguf"], "there is no file nowhere.gguf"),
        (["."], ". is a folder: name the file in it"),
        (["/dev/null"], "/dev/null is not a file"),
        (["x" * 300], " cannot be read: File name too long"),
        (["a\0b"], "cannot be read: "),
        (["x.gguf", "--port", "70000"], "expected a number from 0 to 65535, got 70000"),
        (["x.gguf", "--port", "http"], "'http' is not a whole number"),
        (["x.gguf", "--context", "5"], "expected a number from 256 to 16777216, got 5"),
        (["x.gguf", "--threads", "0"], "expected a number from 1 to 512, got 0"),
    ],
)
def test_a_wrong_request_is_told(words: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert told in refused(capsys, *words)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", " is empty: download it again"),
        (b"GGU", " is not a model for llama.cpp: such files are in the format GGUF"),
        (b"<html>not found</html>", " is not a model for llama.cpp"),
        (b"version https://git-lfs.github.com/spec/v1\n", " is not a model for llama.cpp"),
    ],
)
def test_what_is_no_model_is_told(
    content: bytes, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "model.gguf"
    path.write_bytes(content)
    assert f"{path}{told}" in refused(capsys, str(path))


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_model(tmp_path_factory.mktemp("model") / "tiny.gguf")


def test_a_port_that_somebody_listens_on_is_told(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = str(other.getsockname()[1])
        assert f"port {port} is in use" in refused(capsys, str(model), "--port", port)


def test_a_file_tells_its_context(model: Path) -> None:
    found = examine(model)
    assert found.trained_context == TRAINED_CONTEXT
    assert found.size == model.stat().st_size
