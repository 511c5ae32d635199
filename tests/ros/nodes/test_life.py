"""How nodes begin and end: every one of them, on both signals, at any moment."""

from __future__ import annotations

import itertools
import signal
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly

AT_ONCE = 5
NODES = {
    "hello": "hello_node",
    "mock_sonar": "mock_sonar_front",
    "safety_stop": "safety_node",
    "head_controller": "head_controller",
    "ai_driver": "ai_driver_translator",
    "electronic_differential": "electronic_differential",
    "camera_tf": "camera_tf",
    "mock_camera": "mock_camera",
    "vlm_agent_stub": "vlm_agent",
    "vlm_agent": "vlm_agent",
    "mock_audio": "audio_system",
    "audio": "audio_system",
    "ai_brain": "ai_brain",
    "llm_parser": "llm_parser",
    "drive_to_point": "drive_to_point",
    "mock_robot": "mock_robot",
    "tof_sonar": "tof_sonar_front",
    "chassis": "chassis",
    "camera": "camera",
    "hearing": "hearing",
    "speaking": "speaking",
    "robot_state_publisher": "robot_state_publisher",
}
"""Module to the name in the graph that the course gave it."""
SIGNALS = (signal.SIGINT, signal.SIGTERM)


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    with Peer(module_domain) as peer:
        yield peer


def assert_ended_well(process: NodeProcess) -> None:
    assert process.wait() == 0, process.output
    assert "Traceback" not in process.output
    assert "rror" not in process.output


def test_every_node_ends_with_code_0_and_no_traceback(peer: Peer, module_domain: int, tmp_path: Path) -> None:
    """On one of the two signals each: it is the same code in all that hears both."""
    params: dict[str, dict[str, object]] = {
        "safety_stop": {"gate": True},
        "mock_sonar": {"rate": 100},
        "mock_robot": {"folder": tmp_path},
        # Never the webcam of whoever runs the tests.
        "camera": {"source": "/dev/null"},
    }
    signals = itertools.cycle(SIGNALS)
    # A few at a time: with twenty starting at once each is held up for so long that the
    # middleware may not find it any more.
    for at in range(0, len(NODES), AT_ONCE):
        modules = list(NODES)[at : at + AT_ONCE]
        started = [
            NodeProcess(f"nodes.{each}", module_domain, params=params.get(each, {}), cold=True) for each in modules
        ]
        try:
            for process, module in zip(started, modules, strict=True):
                name = NODES[module]
                wait_until(lambda name=name: peer.sees(name), f"{name} in the graph")  # type: ignore[misc]
                process.wait_for_words(f"[{name}]")
                process.send(next(signals))
            for process, module in zip(started, modules, strict=True):
                assert_ended_well(process)
                # One that just vanished would be believed to be there for its lease of 20 s.
                wait_until(
                    lambda name=NODES[module]: not peer.sees(name),  # type: ignore[misc]
                    f"{module} gone",
                    within_s=15,
                )
        finally:
            for process in started:
                process.close()


def test_a_callback_that_does_not_come_back_is_not_waited_for(module_domain: int) -> None:
    with NodeProcess("tests.ros.sleepy_node", module_domain, cold=True) as process:
        process.wait_for_words("asleep")
        process.send(signal.SIGTERM)
        assert_ended_well(process)


def test_a_signal_while_the_node_is_still_loading_leaves_no_traceback(module_domain: int) -> None:
    early = 0
    for _ in range(20):
        with NodeProcess("nodes.mock_sonar", module_domain, cold=True) as process:
            wait_until(
                lambda process=process: handles_signals(process),  # type: ignore[misc]
                "a handler of SIGTERM",
                every_s=0.001,
            )
            early += not has_loaded_rclpy(process)
            process.send(signal.SIGINT)
            assert_ended_well(process)
        if early == 2:
            break
    assert early, "the signals never came before rclpy was loaded"


def handles_signals(process: NodeProcess) -> bool:
    status = Path(f"/proc/{process.process.pid}/status").read_text()
    caught = next(line for line in status.splitlines() if line.startswith("SigCgt"))
    return bool(int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1)


def has_loaded_rclpy(process: NodeProcess) -> bool:
    return "_rclpy" in Path(f"/proc/{process.process.pid}/maps").read_text()
