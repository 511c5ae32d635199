"""A sound device as the driver keeps it: with programs in the place of miniaudio that go wrong."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, Any

import pytest

from nodes.drivers import sound_child as _sound_child
from nodes.drivers import sound_port as _sound_port
from nodes.drivers.sound_device import IN, OUT, choose
from nodes.drivers.sound_port import SoundPort
from nodes.drivers.sound_queue import SoundQueue
from nodes.parts.translated_logger import TranslatedLogger
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

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
def test_a_device_is_named_by_a_part_of_its_name_or_by_its_number(
    wanted: str, at: int | None
) -> None:
    assert choose(MICROPHONES, wanted) == at


def test_a_queue_forgets_its_oldest() -> None:
    queue = SoundQueue(6)
    assert queue.put(b"abcd") == 0
    assert queue.put(b"efgh") == 2
    assert queue.take(4) == b"cdef"
    assert len(queue) == 2
    assert queue.put(b"0123456789") == 6
    assert queue.take(100) == b"456789"
    queue.put(b"ab")
    queue.clear()
    assert queue.take(100) == b""


class Log:
    """Takes the lines of a node."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.info = self.warning = self.error = self.lines.append


@pytest.fixture
def begin(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., tuple[SoundPort, Log]]]:
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


def test_sound_comes_in_blocks_however_it_is_cut(
    begin: Callable[..., tuple[SoundPort, Log]],
) -> None:
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
        (
            OPENED + "time.sleep(60)",
            "Lost the microphone stub: the library of sound does not answer",
        ),
        ("time.sleep(60)", "No microphone: the library of sound does not answer"),
        (
            "tell(problem='busy')",
            "close the program that uses it (fuser -v /dev/snd/*)",
        ),
        ("tell(problem='missing', detail='')", "plug it in (arecord -l and aplay -l list them)"),
        ("tell(problem='package')", "pip install miniaudio"),
        ("tell(problem='other', detail='{odd} \\x1b[31m')", "{odd} ␛[31m"),
        ("os.write(2, b'\\xff' * 70000 + b'\\n[1]\\n7\\n'); sys.exit(1)", "has died: 7"),
    ],
)
def test_whatever_goes_wrong_is_told_and_tried_again(
    begin: Callable[..., tuple[SoundPort, Log]],
    monkeypatch: pytest.MonkeyPatch,
    program: str,
    words: str,
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


def test_a_child_that_takes_its_time_to_end_is_collected_nevertheless(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "program.py").write_text("import time; time.sleep(60)", encoding="utf-8")
    monkeypatch.setattr(_sound_child, "PROGRAM", tmp_path / "program.py")
    monkeypatch.setattr(_sound_child, "_LAST_WAIT_S", 0.0)
    child = _sound_child.SoundChild(IN, "", RATE_HZ, 100)
    child.close()
    wait_until(lambda: child._process.returncode is not None, "its end is taken note of")


def test_a_card_that_comes_is_seen_at_once(
    begin: Callable[..., tuple[SoundPort, Log]], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    cards = tmp_path / "cards"
    monkeypatch.setattr(_sound_port, "CARDS", cards)
    monkeypatch.setattr(_sound_port, "_FIRST_WAIT_S", 600.0)
    _port, log = begin("tell(problem='missing')")
    has(log, "No microphone")
    _sound_child.PROGRAM.write_text(BEGINNING + OPENED + "time.sleep(60)", encoding="utf-8")
    cards.write_text(" 0 [Device]: USB-Audio\n")
    has(log, "Microphone: stub")


def test_a_card_that_comes_while_one_is_looked_for_is_seen_at_once(
    begin: Callable[..., tuple[SoundPort, Log]], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    cards, tries = tmp_path / "cards", tmp_path / "tries"
    monkeypatch.setattr(_sound_port, "CARDS", cards)
    monkeypatch.setattr(_sound_port, "_FIRST_WAIT_S", 600.0)
    begin(
        f"open({str(tries)!r}, 'a').write('.'); open({str(cards)!r}, 'w').write('0 [Device]')\n"
        "tell(problem='missing')"
    )
    wait_until(lambda: tries.exists() and len(tries.read_text()) == 2, "the second try")


def test_faults_are_counted_over_every_connection(
    begin: Callable[..., tuple[SoundPort, Log]],
) -> None:
    port, _log = begin(OPENED + "tell(faults=2)\ntell(faults=3)\ntell(problem='gone')")
    wait_until(lambda: port.connections == 2 and port.faults == 6, "six faults")


def test_sound_for_a_speaker_that_is_not_there_is_not_kept(
    begin: Callable[..., tuple[SoundPort, Log]], monkeypatch: pytest.MonkeyPatch
) -> None:
    port, log = begin("tell(problem='missing')", OUT, queue_s=1.0)
    has(log, "No speaker")
    assert port.play(bytes(100)) == (0, True), "it may be opened yet"
    monkeypatch.setattr(_sound_port, "_PATIENCE_S", -math.inf)
    assert port.play(bytes(100)) == (100, False)


def test_none_is_no_device(begin: Callable[..., tuple[SoundPort, Log]]) -> None:
    port, log = begin("sys.exit(1)", OUT)
    port.close()
    off = SoundPort(TranslatedLogger(log, "en"), OUT, "None", RATE_HZ, 100)  # type: ignore[arg-type]
    off.start()
    assert not off.wants
    assert not off._thread.is_alive()
    off.close()
