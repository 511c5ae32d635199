"""What drivers share: a serial port as they keep it, the Pico behind one, and what is told."""

from __future__ import annotations

import termios
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any, NoReturn

import pytest
import serial

from nodes.drivers import pico as _pico_client
from nodes.drivers.pico import SILENT_AFTER_S, PicoClient, StandstillLogger
from nodes.drivers.serial_link import SerialLink
from nodes.parts import node as _translated_logger
from nodes.parts.node import TranslatedLogger
from robot.wire.pico import Telemetry, encode
from tests.waiting import wait_until


class Log:
    """Takes the lines of a node."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.info = self.warning = self.error = self.lines.append


@pytest.fixture
def link() -> Iterator[tuple[SerialLink, Log]]:
    log = Log()
    said: Any = TranslatedLogger(log, "en")  # type: ignore[arg-type]
    node: Any = SimpleNamespace(
        say=said, values={"port": "/dev/ttyACM0"}, quick_publisher=lambda *_: None, every=lambda *_: None
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
    wait_until(lambda: link[0].connections >= 3, "three tries")
    assert len(closed) >= 2
    link[0].write(b"1")
    assert any("gone" in line for line in link[1].lines)


# ---------------------------------------------------------------- why the wheels stand


def telemetry(flags: str, refused: int = 0) -> Telemetry:
    return Telemetry(1, 20, 0, 0.0, 0.0, 0.0, 7.4, 0.0, 0.0, refused, frozenset(flags))


def test_why_the_wheels_stand_is_told_again_while_it_lasts(monkeypatch: pytest.MonkeyPatch) -> None:
    clock: Any = SimpleNamespace(now_s=1000.0, monotonic=lambda: clock.now_s)
    monkeypatch.setattr(_translated_logger, "time", clock)
    log = Log()
    standstill = StandstillLogger(TranslatedLogger(log, "en"))  # type: ignore[arg-type]

    def told(flags: str | None, seconds: float) -> list[str]:
        """What is logged of these flags in so many seconds."""
        log.lines.clear()
        for _ in range(round(seconds / 0.5)):
            standstill.tell(None if flags is None else telemetry(flags))
            clock.now_s += 0.5
        return list(log.lines)

    weak = "The wheels stand: the battery is weak"
    left = "The wheels stand: fault of the left motor driver"
    assert told("", 20) == told(None, 20) == told("WA", 20) == []
    assert told("UA", 35) == [weak] * 4
    assert told("LUA", 1) == [f"{left}, the battery is weak"]
    assert told("L", 1) == []
    assert told(None, 1) == []
    assert told("L", 1) == [left]


def test_what_the_pico_refuses_is_told_and_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    clock: Any = SimpleNamespace(now_s=1000.0, monotonic=lambda: clock.now_s)
    monkeypatch.setattr(_translated_logger, "time", clock)
    log = Log()
    standstill = StandstillLogger(TranslatedLogger(log, "en"))  # type: ignore[arg-type]

    def told(*counts: int | None) -> list[str]:
        """How many lines are told of, when these counts come one after the other in 10 s."""
        log.lines.clear()
        for count in counts:
            standstill.tell(None if count is None else telemetry("", count))
            clock.now_s += 10 / len(counts)
        return [line.partition(" lines")[0].rpartition(" ")[2] for line in log.lines]

    assert told(None, 7, 7) == [], "what was before"
    assert told(7, 8, 20) == ["1"]
    assert told(20, 20) == ["12"]
    assert told(20, 3, 3) == [], "a new start of the Pico"
    assert told(4) == ["1"]


# ---------------------------------------------------------------- a Pico that answers or not


WORD = encode(Telemetry(1, 20, 0, 0.0, 0.0, 0.0, 7.4, 0.0, 0.0, 0, frozenset()))


class Link:
    """A port that opens and goes when a test says so."""

    port = "/dev/ttyACM0"
    connected = False

    def __init__(
        self,
        _node: object,
        _baud: int,
        heard: Callable[[bytes], None],
        opened: Callable[[], None],
        lost: Callable[[], None],
        _frames: object,
    ) -> None:
        self.heard, self.opened, self.lost = heard, opened, lost

    def write(self, _data: bytes) -> bool:
        return self.connected


def test_a_port_that_has_just_opened_is_not_silent_yet(monkeypatch: pytest.MonkeyPatch) -> None:
    """Between the opening and the greeting, the first time and again after a loss."""
    clock: Any = SimpleNamespace(now_s=1000.0, monotonic=lambda: clock.now_s)
    monkeypatch.setattr(_pico_client, "time", clock)
    monkeypatch.setattr(_pico_client, "SerialLink", Link)
    node: Any = SimpleNamespace(say=TranslatedLogger(Log(), "en"))  # type: ignore[arg-type]
    client = PicoClient(node, 115_200, lambda _telemetry: None)
    link: Any = client.link

    def silent() -> bool:
        return client.silent

    for _connection in range(2):
        client.drive(0.0, 0.0, 0.0)
        clock.now_s += 10.0
        link.connected = True
        client.drive(0.0, 0.0, 0.0)
        assert not silent()
        link.opened()
        clock.now_s += 0.9 * SILENT_AFTER_S
        assert not silent()
        clock.now_s += 0.2 * SILENT_AFTER_S
        assert silent()
        link.heard(WORD)
        assert client.answers
        assert not silent()
        clock.now_s += 1.1 * SILENT_AFTER_S
        assert silent()
        link.connected = False
        link.lost()
