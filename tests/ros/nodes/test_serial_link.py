"""A serial port as a driver keeps it: what goes wrong is told with its fix."""

from __future__ import annotations

import termios
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NoReturn

import pytest
import serial

from nodes.drivers.serial_link import SerialLink
from nodes.parts.translated_logger import TranslatedLogger
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator


class Log:
    """Takes the lines of a node."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.info = self.warning = self.error = self.lines.append


@pytest.fixture(params=["en", "ru"])
def link(request: pytest.FixtureRequest) -> Iterator[tuple[SerialLink, Log]]:
    log = Log()
    said: Any = TranslatedLogger(log, request.param)  # type: ignore[arg-type]
    node: Any = SimpleNamespace(
        say=said,
        text=lambda _name: "/dev/ttyACM0",
        quick_publisher=lambda *_: None,
        every=lambda *_: None,
    )
    link = SerialLink(node, 9600, lambda _: None, lambda: None, lambda: None)
    yield link, log
    link.close()
    assert not link._thread.is_alive()


@pytest.mark.parametrize(
    ("number", "fix"),
    [(2, "by-id"), (13, "dialout"), (1, "dialout"), (11, "fuser -v /dev/ttyACM0"), (16, "fuser"),
     (25, "/dev/ttyACM0"), (5, "odd")],
)  # fmt: skip
def test_why_a_port_does_not_open_is_told_with_the_mend(
    link: tuple[SerialLink, Log], monkeypatch: pytest.MonkeyPatch, number: int, fix: str
) -> None:
    def refuse(*_: object, **__: object) -> NoReturn:
        raise serial.SerialException(number, "odd")

    monkeypatch.setattr("nodes.drivers.serial_link.serial.Serial", refuse)
    link[0].start()
    wait_until(lambda: link[1].lines, "a line")
    assert fix in link[1].lines[0]
    assert not link[0].connected
    assert link[0].write(b"1") is False
    assert link[0].status("x", 0).level == b"\x02"


@pytest.mark.parametrize("error", [OSError(5, "gone"), termios.error(5, "gone"), TypeError("gone")])
def test_every_way_in_which_pyserial_fails_leads_to_a_new_try(
    link: tuple[SerialLink, Log], monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    closed = []

    class Broken:
        def __init__(self, *_: object, **__: object) -> None:
            pass

        def fileno(self) -> NoReturn:
            raise error

        def write(self, _data: bytes) -> NoReturn:
            raise error

        def close(self) -> NoReturn:
            closed.append(True)
            raise error

    monkeypatch.setattr("nodes.drivers.serial_link.serial.Serial", Broken)
    link[0].start()
    wait_until(lambda: link[0].traffic.connections >= 3, "three tries")
    assert len(closed) >= 2
    link[0].write(b"1")
    assert any("gone" in line for line in link[1].lines)
