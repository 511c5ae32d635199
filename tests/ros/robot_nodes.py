"""The nodes between a command and the wheels, as profiles/robot.yaml starts them."""

from __future__ import annotations

import random
import signal
from dataclasses import replace
from typing import TYPE_CHECKING

from launcher.profile.load import load_profile
from tests.ros.devices import mock_robot
from tests.ros.node_process import NodeProcess
from tests.ros.peer import ROOT, Peer
from tests.ros.wheels import Wheels
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

NODES = ("chassis", "electronic_differential", "safety_stop", "sonar_front", "sonar_rear")
BELIEVED_S = 0.4
"""So long a command counts that is not renewed."""
READY = {
    "chassis": "The Pico answers",
    "electronic_differential": "listens to /drive_safe",
    "safety_stop": "",
    "sonar_front": "Connected",
    "sonar_rear": "Connected",
    "head_controller": "The servo controller answers",
    "camera_tf": "camera_link relative to",
    "robot_state_publisher": "deck_robot: 13 links",
}
"""Words that a node says once it works."""
OWN = {"safety_stop": {"max_age_s": BELIEVED_S, "critical_distance": 0.3, "slow_distance": 0.0}}
"""What differs from the profile: the tests want little time and drive in a small circle."""


class RobotNodes:
    """The emulated robot, the nodes that drive it, and somebody who commands and watches."""

    def __init__(self, domain: int, folder: Path) -> None:
        self.domain, self.folder = domain, folder
        self.peer = Peer(domain)
        self.wheels = Wheels(self.peer)
        self.start_robot()
        self.processes: dict[str, NodeProcess] = {}
        self._woken: set[str] = set()
        environ = {"DECK_RUN_DIR": str(folder.parent)}
        self._specs = load_profile(ROOT / "profiles" / "robot.yaml", environ=environ).nodes
        wait_until(lambda: self.wheels.told, "news of the motors")

    def start_robot(self) -> None:
        self.robot = mock_robot(self.domain, self.folder, noise=0.0, dropout=0.0)
        self.robot.wait_for_words("The simulated robot is in")

    def kill_robot(self) -> None:
        """Let it be gone as if its power were."""
        self.robot.send(signal.SIGKILL)
        self.robot.close()

    def start(self, *names: str) -> None:
        """Start nodes, one right after the other, and wait until each works."""
        for name in names:
            spec = self._specs[name]
            assert spec.run is not None
            params = {**spec.params, **OWN.get(name, {})}
            if "port" in params:
                params["port"] = str(self.folder / str(params["port"]).rpartition("/")[2])
            arguments = tuple(replace(spec, params=params).ros_args())
            self.processes[name] = NodeProcess(spec.run, self.domain, arguments=arguments)
        for name in names:
            self.processes[name].wait_for_words(READY[name])

    def end(self, *names: str, number: signal.Signals = signal.SIGINT, codes: tuple[int, ...] = (0,)) -> None:
        """Send nodes a signal, one right after the other, and wait until each has ended."""
        for name in names:
            self.processes[name].send(number)
        for name in names:
            code = self.processes[name].wait()
            assert code in (codes if number != signal.SIGKILL else (-number,)), name
            self.processes.pop(name).close()

    def hang(self, name: str) -> None:
        self.processes[name].send(signal.SIGSTOP)

    def wake(self, name: str) -> None:
        self._woken.add(name)
        self.processes[name].send(signal.SIGCONT)

    def renew(self) -> None:
        """Start the nodes that were woken anew.

        Fast DDS may have left them deaf: others replace the port of a node that hangs for over a
        second, and may remove the one at which it listens after that (seen in 1 of 250 rounds: it
        listened at a deleted port, and two of four others wrote to another).
        """
        names = sorted(self._woken & self.processes.keys())
        self._woken.clear()
        # Some do not let go of the middleware either, and end with 1 (see `nodes.parts.runner`).
        self.end(*names, codes=(0, 1))
        self.start(*names)

    def said(self) -> str:
        """What the nodes said last, for whoever reads of a test that failed."""
        ends = ([f"--- {name}", *process.output.splitlines()[-12:]] for name, process in self.processes.items())
        return "\n".join(line for end in ends for line in end)

    def mend(self) -> None:
        """Let every node run, whatever a test has left."""
        for name in NODES:
            process = self.processes.get(name)
            if process is None or process.process.poll() is not None:
                self.start(name)
            elif process.hung:
                self.wake(name)
        self.renew()

    def close(self) -> None:
        self.wheels.quiet()
        for process in self.processes.values():
            process.send(signal.SIGCONT)
            process.close()
        self.robot.close()
        self.peer.close()


def shuffled(names: Iterable[str], seed: int) -> list[str]:
    """The names in another order, the same each time."""
    order = list(names)
    random.Random(seed).shuffle(order)
    return order
