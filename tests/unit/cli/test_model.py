"""`deck model serve` before llama.cpp gets the file: what it refuses, and in which words."""

from __future__ import annotations

import socket
import struct
import sys
from pathlib import Path

import gguf
import pytest
from hypothesis import given
from hypothesis import strategies as st

from brain.serving.faults import ServingError
from brain.serving.model_file import examine
from cli import main
from cli.doctor.llama import LlamaFacts, diagnose
from tests.tiny_model import TRAINED_CONTEXT, write_model


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """Run it; return what it says in refusing."""
    assert main(["model", "serve", *words]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    return said.err.strip()


def test_alone_it_shows_its_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["model"]) == 0
    assert "serve a model from a file on this machine" in capsys.readouterr().out


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
def test_a_wrong_request_is_told(
    words: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert told in refused(capsys, *words)


def test_another_action_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["model", "train"]) == 2
    assert "invalid choice: 'train'" in capsys.readouterr().err


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


def test_without_the_extra_the_command_is_told_that_installs_it(
    model: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "xllamacpp", None)
    told = refused(capsys, str(model))
    assert told.startswith("llama.cpp is not installed: ")
    assert told.endswith(" -m pip install 'xllamacpp>=2026.10'")


@pytest.mark.parametrize("host", ["192.0.2.1", "no-such-host.invalid", "x" * 70 + ".y"])
def test_an_address_of_another_machine_is_told(
    host: str, model: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert f"{host} is not an address of this machine: " in refused(
        capsys, str(model), "--host", host
    )


def test_a_port_that_somebody_listens_on_is_told(
    model: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = str(other.getsockname()[1])
        assert f"port {port} is in use" in refused(capsys, str(model), "--port", port)


def test_a_file_tells_its_context(model: Path) -> None:
    found = examine(model)
    assert found.trained_context == TRAINED_CONTEXT
    assert found.size == model.stat().st_size


def test_lists_before_the_context_are_read_over(tmp_path: Path) -> None:
    path = tmp_path / "tagged.gguf"
    writer = gguf.GGUFWriter(str(path), "qwen3")
    writer.add_array("general.tags", ["text-generation", "chat"])
    writer.add_array("general.numbers", [1, 2, 3])
    writer.add_float32("general.weight", 0.5)
    writer.add_context_length(40960)
    writer.write_header_to_file()
    writer.write_kv_data_to_file()
    writer.close()
    assert examine(path).trained_context == 40960


def test_a_long_list_ends_the_reading(tmp_path: Path) -> None:
    path = tmp_path / "long.gguf"
    header = b"GGUF" + struct.pack("<IQQ", 3, 0, 1)
    path.write_bytes(header + struct.pack("<Q", 1) + b"x" + struct.pack("<IIQ", 9, 8, 1 << 60))
    assert examine(path).trained_context is None


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("Qwen3-1.7B-Q4_K_M.gguf", "Qwen3-1.7B-Q4_K_M"),
        ("да $(rm) 'x'.gguf", "rm-x"),
        ("мой.gguf", "model"),
        ("x" * 200 + ".gguf", "x" * 100),
    ],
)
def test_the_name_of_a_model_needs_no_quotes(file: str, name: str, tmp_path: Path) -> None:
    path = tmp_path / file
    path.write_bytes(b"GGUF")
    assert examine(path).name == name


@given(data=st.data())
def test_a_damaged_header_is_no_surprise(data: st.DataObject, model: Path) -> None:
    content = bytearray(model.read_bytes()[: data.draw(st.integers(1, 4000))])
    for _number in range(data.draw(st.integers(0, 8))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path = model.with_name("damaged.gguf")
    path.write_bytes(content)
    try:
        examine(path)
    except ServingError as error:
        assert "is not a model for llama.cpp" in str(error)  # noqa: PT017 - or none at all


def test_the_doctor_tells_whether_it_is_there() -> None:
    (there,) = diagnose(LlamaFacts("2026.10.1"))
    assert there.text == "llama.cpp (xllamacpp 2026.10.1): `deck model serve` works"
    (missing,) = diagnose(LlamaFacts(None, "/a b/python"))
    assert missing.text.endswith("needs it: '/a b/python' -m pip install xllamacpp")
