"""What drivers tell of the frames on their ports: only while somebody listens, both ways."""

from __future__ import annotations

import time
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import String

from nodes.drivers.serial_frames import SerialFrames
from nodes.parts.translated_logger import TranslatedLogger
from robot.frames.lines import decode
from robot.frames.protocols import FrameKind, RawReader
from tests.ros.devices import mock_robot, set_parameter
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from nodes.parts.node import LessonNode
    from robot.frames.lines import FrameLine

pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module")
def folder(module_domain: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = tmp_path_factory.mktemp("frames")
    with mock_robot(module_domain, folder, dropout=0.0) as robot:
        robot.wait_for_words("The simulated robot")
        yield folder


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    with Peer(module_domain) as peer:
        yield peer


def lines(heard: list[String]) -> list[FrameLine]:
    """All frames heard so far; every line of them can be read."""
    read = [decode(message.data) for message in heard]
    assert all(not odd for _found, odd in read)
    return [line for found, _odd in read for line in found]


def status(told: list[DiagnosticArray]) -> dict[str, str]:
    return {item.key: item.value for item in told[-1].status[0].values} if told else {}


def test_the_chassis_tells_both_ways_to_whoever_listens(
    peer: Peer, module_domain: int, folder: Path
) -> None:
    told = peer.hear("/diagnostics", DiagnosticArray)
    with NodeProcess("nodes.chassis", module_domain, params={"port": folder / "pico"}) as node:
        node.wait_for_words("The Pico answers")
        wait_until(lambda: float(status(told).get("frames_in_per_s", "0")) > 20, "frames a second")
        began_s = time.time()
        heard = peer.hear("/chassis/frames", String)
        wait_until(lambda: len(lines(heard)) > 60, "frames")
        found = lines(heard)
        assert all(line.time_s >= began_s for line in found), "it kept what nobody wanted"
        assert {line.way for line in found if line.text.startswith("drive left 0.00")} == {"out"}
        assert {line.way for line in found if line.text.startswith("wheels left")} == {"in"}
        assert all(line.octets.startswith(b"$") for line in found if line.kind is FrameKind.FRAME)
        assert [line.kind for line in found].count(FrameKind.FRAME) == len(found)
        values = status(told)
        assert float(values["bytes_in_per_s"]) > 1000 < float(values["bytes_out_per_s"]) + 500
        assert values["connected_since"][:4] == time.strftime("%Y")
        assert values["reconnects"] == "0"


def test_noise_is_shown_as_what_it_is(peer: Peer, module_domain: int, folder: Path) -> None:
    params: dict[str, object] = {"port": folder / "tof_front"}
    told = peer.hear("/diagnostics", DiagnosticArray)
    with NodeProcess("nodes.tof_sonar", module_domain, params=params, lang="ru") as node:
        node.wait_for_words("Подключено")
        heard = peer.hear("/tof_sonar_front/frames", String)
        wait_until(lambda: len(lines(heard)) > 20, "frames")
        assert all("расстояние" in line.text for line in lines(heard))
        set_parameter(peer, "mock_robot", "tof_front", "noise")

        def spoiled() -> bool:
            found = lines(heard)
            bad = [line for line in found if line.kind is FrameKind.BAD]
            loose = [line for line in found if line.kind is FrameKind.NOISE]
            return any("СУММА" in line.text for line in bad) and any(
                line.text == f"шум, байт: {len(line.octets)}" for line in loose
            )

        wait_until(spoiled, "noise and failed checks")
        wait_until(lambda: float(status(told)["errors"]) > 0, "errors counted")
        set_parameter(peer, "mock_robot", "tof_front", "unplugged")
        node.wait_for_words("Потерян")
        wait_until(lambda: status(told)["connected"] == "false", "a lost port")
        assert status(told)["connected_since"] == ""
        set_parameter(peer, "mock_robot", "tof_front", "fine")
        wait_until(lambda: status(told)["reconnects"] == "1", "a port that is back")


class Fake:
    """A node with one publisher and one timer, both driven by the test."""

    def __init__(self) -> None:
        self.say: Any = TranslatedLogger(SimpleNamespace(), "en")  # type: ignore[arg-type]
        self.listeners = 0
        self.published: list[String] = []
        self.look: Any = None
        self.timer = SimpleNamespace(timer_period_ns=0, reset=lambda: None)

    def quick_publisher(self, *_: object) -> Any:
        return SimpleNamespace(
            get_subscription_count=lambda: self.listeners, publish=self.published.append
        )

    def every(self, _period_s: float, look: object) -> Any:
        self.look = look
        return self.timer


def test_without_a_listener_nothing_is_kept_and_it_looks_once_a_second() -> None:
    node = Fake()
    frames = SerialFrames(cast("LessonNode", node), RawReader)
    frames.note("in", b"one")
    assert not frames._chunks
    node.look()
    assert (node.published, node.timer.timer_period_ns) == ([], 0)
    node.listeners = 1
    node.look()
    assert node.timer.timer_period_ns == 200_000_000
    frames.note("in", b"two")
    frames.note("out", b"x" * 20_000)
    node.look()
    assert [line.octets or line.text for line in lines(node.published)] == [
        b"two",
        "20000 more bytes",
    ]
    node.look()
    assert len(node.published) == 1
    node.listeners = 0
    node.look()
    assert node.timer.timer_period_ns == 1_000_000_000
    frames.note("in", b"three")
    assert not frames._chunks
