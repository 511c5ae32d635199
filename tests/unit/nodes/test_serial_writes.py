"""A port that takes nothing for a while gets each line whole that was begun."""

from __future__ import annotations

import contextlib
import os
import pty
from collections.abc import Iterator

import pytest
import serial

from nodes.drivers.serial_writes import SerialWrites
from tests.waiting import wait_until


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


def test_a_line_that_a_full_port_has_cut_is_finished_before_the_next(
    ends: tuple[int, serial.Serial],
) -> None:
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
