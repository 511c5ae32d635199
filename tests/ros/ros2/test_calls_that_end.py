"""A node that hangs, or dies, holds up no command of `ros2` for ever."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from tests.ros.peer import DISCOVERY, ROOT
from tests.ros.ros2.typed import typed

HUNG = """
import threading, rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger
rclpy.init()
hung, well = Node("hung"), Node("well")
hung.declare_parameter("rate", 1.0)
hung.create_service(Trigger, "/never", lambda request, response: response)
well.declare_parameter("speed", 2.0)
print("here", flush=True)
rclpy.spin(well)
"""
"""Of two nodes in one process only one is spun."""


@contextmanager
def program(text: str, domain: int) -> Iterator[subprocess.Popen[str]]:
    """A program of somebody's own, until it says that it is there."""
    with subprocess.Popen(
        [sys.executable, "-c", text],
        cwd=ROOT,
        env={**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(domain)},
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            assert process.stdout is not None
            assert any(line == "here\n" for line in process.stdout)
            yield process
        finally:
            process.kill()


@pytest.fixture(scope="module")
def hung(module_domain: int) -> Iterator[int]:
    with program(HUNG, module_domain):
        yield module_domain


@pytest.mark.parametrize(
    "words",
    [
        ("param", "get", "/hung", "rate"),
        ("param", "dump", "/hung"),
        ("param", "set", "/hung", "rate", "2.0"),
        ("service", "call", "/never", "std_srvs/srv/Trigger"),
    ],
    ids=" ".join,
)
def test_whoever_does_not_answer_is_named(
    hung: int, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(hung))
    asked = typed(*words, "--timeout", "0.5")
    assert asked.code == 1
    assert f"{'/never' if words[0] == 'service' else '/hung'} has not answered" in asked.err
