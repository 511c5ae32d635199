"""Parts of nodes: cameras, ports, the stall detector, what is logged."""

from __future__ import annotations

import contextlib
import os
import pty
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
import serial

from nodes.drivers.capture import CameraSource, SourceKind
from nodes.drivers.serial_link import SerialWrites
from nodes.parts.commands import StallDetector
from nodes.simulated.devices import PseudoSerial
from tests.waiting import wait_until


@pytest.mark.parametrize(
    ("name", "kind", "shown"),
    [
        ("0", SourceKind.DEVICE, "/dev/video0"),
        ("12", SourceKind.DEVICE, "/dev/video12"),
        ("/dev/v4l/by-id/usb-x", SourceKind.DEVICE, "/dev/v4l/by-id/usb-x"),
        ("film.avi", SourceKind.FILE, "film.avi"),
        ("http://pi:8080/x?a=b@c", SourceKind.STREAM, "http://pi:8080/x?a=b@c"),
        ("rtsp://me:secret@pi/x", SourceKind.STREAM, "rtsp://me:***@pi/x"),
        ("rtsp://me:a:b@pi/x", SourceKind.STREAM, "rtsp://me:***@pi/x"),
    ],
)
def test_a_source_is_known_by_its_name(name: str, kind: SourceKind, shown: str) -> None:
    source = CameraSource(name)
    assert (source.kind, str(source)) == (kind, shown)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("/dev/video99", "no such camera"),
        ("/dev/null", "no pictures"),
        ("/dev/shm", "it is not a camera"),
        ("http://x", "nothing answers"),
    ],
)
def test_why_it_does_not_open_is_told(name: str, words: str) -> None:
    assert words in CameraSource(name).why_not()


def test_what_an_earlier_device_has_left_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "pico"
    path.symlink_to("/dev/pts/4000")
    device = PseudoSerial(path)
    assert str(path.readlink()) != "/dev/pts/4000"
    device.unplug()
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def ends() -> Iterator[tuple[int, serial.Serial]]:
    """The device's end, and the driver's."""
    device, driver = pty.openpty()
    port = serial.Serial(os.ttyname(driver), 115200)
    os.set_blocking(device, False)
    yield device, port
    port.close()
    os.close(driver)
    os.close(device)


def arrived(device: int) -> bytes:
    """What the device gets until nothing more is there."""
    found = b""
    with contextlib.suppress(BlockingIOError):
        while more := os.read(device, 4096):
            found += more
    return found


def test_a_line_that_a_full_port_has_cut_is_finished_before_the_next(ends: tuple[int, serial.Serial]) -> None:
    device, port = ends
    writes = SerialWrites(port)
    long = b"x" * 200_000 + b"\n"
    assert writes.write(long), "it is begun"
    whole = bytearray(arrived(device))
    assert len(whole) < len(long), "a port takes less at once"

    def takes_the_next() -> bool:
        whole.extend(arrived(device))
        return writes.write(b"next\n")

    wait_until(takes_the_next, "the port takes the next line")
    assert whole + arrived(device) == long + b"next\n"


def test_a_port_that_is_gone_says_so(ends: tuple[int, serial.Serial]) -> None:
    _device, port = ends
    writes = SerialWrites(port)
    assert writes.write(b"here\n")
    port.close()
    with pytest.raises(serial.SerialException, match="not open"):
        writes.write(b"gone\n")


@dataclass
class Stamp:
    """As in a message's header."""

    sec: int
    nanosec: int


def stamp(age_s: float) -> Stamp:
    now_ns = time.time_ns() - int(age_s * 1e9)
    return Stamp(*divmod(now_ns, 10**9))


@pytest.fixture
def woken(monkeypatch: pytest.MonkeyPatch) -> StallDetector:
    """One who was away for 2 s and came back this moment."""
    stalls = StallDetector()
    now_s = time.monotonic() + 2.0
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    assert stalls.lasted(0.5)
    return stalls


def later(monkeypatch: pytest.MonkeyPatch, by_s: float) -> None:
    now_s = time.monotonic() + by_s
    monkeypatch.setattr(time, "monotonic", lambda: now_s)


def test_who_was_not_away_takes_everything_in() -> None:
    stalls = StallDetector()
    assert not stalls.lasted(0.5)
    assert not stalls.kept_waiting(stamp(0.4))


def test_just_awake_it_takes_nothing_in(woken: StallDetector, monkeypatch: pytest.MonkeyPatch) -> None:
    later(monkeypatch, 0.4)
    assert woken.lasted(0.5)
    later(monkeypatch, 0.2)
    assert not woken.lasted(0.5)


def test_what_was_sent_meanwhile_is_known_by_its_stamp_though_it_comes_late(
    woken: StallDetector, monkeypatch: pytest.MonkeyPatch
) -> None:
    later(monkeypatch, 0.8)
    assert woken.lasted(1.0) is False
    assert woken.kept_waiting(stamp(0.9))
    assert not woken.kept_waiting(stamp(0.7))
