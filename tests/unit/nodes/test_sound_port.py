"""A sound device as the driver keeps it: with programs in the place of miniaudio that go wrong."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from nodes.drivers import sound_port as _sound_child
from nodes.drivers import sound_port as _sound_port
from nodes.drivers.sound_device import IN, OUT, choose
from nodes.drivers.sound_port import SoundPort
from nodes.parts.node import TranslatedLogger
from tests.waiting import wait_until

RATE_HZ = 8000
BEGINNING = """
import json, os, sys, time
def tell(**words): os.write(2, json.dumps(words).encode() + b"\\n")
"""
OPENED = 'tell(opened="stub")\n'
MICROPHONES = ("HDMI", "USB PnP Sound Device, USB Audio", "usb")


@pytest.mark.parametrize(
    ("wanted", "at"),
    [("USB PnP", 1), ("usb", 2), ("audio", 1), ("1", 1), ("9", None), ("MAX98357A", None),
     ("²", None)],
)  # fmt: skip
def test_a_device_is_named_by_a_part_of_its_name_or_by_its_number(wanted: str, at: int | None) -> None:
    assert choose(MICROPHONES, wanted) == at


class Log:
    """Takes the lines of a node."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.info = self.warning = self.error = self.lines.append


@pytest.fixture
def begin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., tuple[SoundPort, Log]]]:
    """Open a port on a program of a few lines; the port and its log come back."""
    ports = []

    def begin(program: str, way: str = IN, **more: Any) -> tuple[SoundPort, Log]:
        path = tmp_path / "program.py"
        path.write_text(BEGINNING + program, encoding="utf-8")
        monkeypatch.setattr(_sound_child, "PROGRAM", path)
        log = Log()
        say = TranslatedLogger(log, "en")  # type: ignore[arg-type]
        ports.append(SoundPort(say, way, "", RATE_HZ, 100, **more))
        ports[-1].start()
        return ports[-1], log

    yield begin
    for port in ports:
        port.close()
        wait_until(lambda port=port: not port._thread.is_alive(), "the end of the thread")  # type: ignore[misc]


def has(log: Log, words: str) -> None:
    wait_until(lambda: any(words in line for line in log.lines), words)


def test_sound_comes_in_blocks_however_it_is_cut(begin: Callable[..., tuple[SoundPort, Log]]) -> None:
    heard: list[bytes] = []
    program = OPENED + "for at in range(40): os.write(1, bytes([at]) * 333)\ntime.sleep(60)\n"
    port, log = begin(program, heard=heard.append)
    wait_until(lambda: len(heard) == 8, "blocks")
    assert {len(block) for block in heard} == {1600}
    assert b"".join(heard) == b"".join(bytes([at]) * 333 for at in range(40))[: 8 * 1600]
    assert port.connected
    assert log.lines == ["Microphone: stub, 8000 Hz"]


def test_sound_goes_out_whole(begin: Callable[..., tuple[SoundPort, Log]], tmp_path: Path) -> None:
    played = tmp_path / "played"
    program = OPENED + f"while True: open({str(played)!r}, 'ab').write(os.read(0, 9999))\n"
    port, log = begin(program, OUT, queue_s=2.0)
    has(log, "Speaker: stub, 8000 Hz")
    sound = struct.pack("<h", 500) * 4000
    port.play(sound)
    wait_until(lambda: played.exists() and played.read_bytes() == sound, "all of it")


@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("sys.exit(3)", "No microphone: the library of sound has died: exit code 3"),
        ("os.write(2, b'Assertion failed\\n'); os.abort()", "has died: Assertion failed"),
        (OPENED + "os._exit(1)", "Lost the microphone stub: the library of sound has died"),
        (OPENED + "time.sleep(60)", "Lost the microphone stub: the library of sound does not answer"),
        ("time.sleep(60)", "No microphone: the library of sound does not answer"),
        ("tell(problem='busy')", "close the program that uses it (fuser -v /dev/snd/*)"),
        ("tell(problem='missing', detail='')", "plug it in (arecord -l and aplay -l list them)"),
        ("tell(problem='package')", "pip install miniaudio"),
        ("tell(problem='other', detail='{odd} \\x1b[31m')", "{odd} ␛[31m"),
        ("os.write(2, b'\\xff' * 70000 + b'\\n[1]\\n7\\n'); sys.exit(1)", "has died: 7"),
    ],
)
def test_whatever_goes_wrong_is_told_and_tried_again(
    begin: Callable[..., tuple[SoundPort, Log]], monkeypatch: pytest.MonkeyPatch, program: str, words: str
) -> None:
    monkeypatch.setattr(_sound_port, "_FIRST_WAIT_S", 0.02)
    monkeypatch.setattr(_sound_port, "_OPEN_S", 1.0)
    monkeypatch.setattr(_sound_port, "_ANSWER_S", 0.3)
    port, log = begin(program)
    has(log, words)
    assert not port.connected
    assert port.problem in log.lines[-1]
    again = OPENED + "time.sleep(60)"
    monkeypatch.setattr(_sound_port, "_ANSWER_S", 30.0)
    _sound_child.PROGRAM.write_text(BEGINNING + again, encoding="utf-8")
    has(log, "Microphone: stub")
