"""The computer's side of the Pico: when nothing answers, and when that is not yet known."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from nodes.drivers import pico as _pico_client
from nodes.drivers.pico import SILENT_AFTER_S, PicoClient
from nodes.parts.translated_logger import TranslatedLogger
from robot.wire.pico import Telemetry, encode
from tests.ros.nodes.test_serial_link import Log

if TYPE_CHECKING:
    from collections.abc import Callable

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
