"""Machines of the kernel's own making: a network and a /dev/shm each, on no wire but their own."""

from __future__ import annotations

import os
import socket
import subprocess
from functools import cache
from ipaddress import ip_address
from pathlib import Path
from typing import TYPE_CHECKING

from tests.waiting import wait_until

if TYPE_CHECKING:
    from typing_extensions import Self

ROOT = Path(__file__).resolve().parents[1]
ALONE = ("--net", "--mount")
SHOT, KEPT = 2, 0
"""What a filter says of a packet. Source: linux/pkt_cls.h, TC_ACT_SHOT and TC_ACT_OK."""
FIRST_DYNAMIC_PORT = 32768
"""Below it is what somebody chose: the ports of the domains 1 to 101 are, those of senders not."""


class Machine:
    """Holds a network and a /dev/shm for as long as it is open; anybody may make one.

    `beside` is another one, made before, to which a cable is laid.
    """

    def __init__(self, address: str, beside: Machine | None = None) -> None:
        self.address = address
        maker = beside.inside() if beside else ()
        told = "mount -t tmpfs none /dev/shm && ip link set lo up && echo ready && exec sleep infinity"
        self._holder = subprocess.Popen(
            [*maker, "unshare", *(() if beside else _rights()), *ALONE, "sh", "-c", told],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self._holder.stdout is not None
        assert self._holder.stdout.readline() == "ready\n"
        if beside:
            beside._lay_cable_to(self)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        assert self._holder.stdout is not None
        self._holder.kill()
        self._holder.wait()
        self._holder.stdout.close()

    def inside(self, folder: Path = ROOT) -> tuple[str, ...]:
        """Return what a command begins with that runs here, in this folder."""
        user = ("--user", "--preserve-credentials") if _rights() else ()
        target = f"--target={self._holder.pid}"
        return ("nsenter", target, *user, *ALONE, "env", f"--chdir={folder}")

    def listening(self) -> list[str]:
        """Return the UDP ports that somebody here has chosen to listen at, as `address:port`."""
        table = self._run("cat", "/proc/self/net/udp").splitlines()[1:]
        sockets = [line.split()[1].split(":") for line in table]
        return [
            f"{ip_address(socket.ntohl(int(address, 16)))}:{int(port, 16)}"
            for address, port in sockets
            if int(port, 16) < FIRST_DYNAMIC_PORT
        ]

    def lose(self, share: float) -> None:
        """Lose this share of the packets that come by the cable, at random."""
        self._run("tc", "qdisc", "add", "dev", "cable", "clsact")
        # Not netem, which many kernels lack. BPF: load a random number; from the bound on keep it.
        random, bound = 0xFFFFF038, int(share * 2**32)
        program = f"4,32 0 0 {random},53 1 0 {bound},6 0 0 {SHOT},6 0 0 {KEPT}"
        here = ("filter", "add", "dev", "cable", "ingress")
        self._run("tc", *here, "bpf", "direct-action", "bytecode", program)

    def received_bytes(self) -> int:
        """Return what has come by the cable so far."""
        table = self._run("cat", "/proc/net/dev").splitlines()
        return next(int(line.split()[1]) for line in table if line.split()[0] == "cable:")

    def _lay_cable_to(self, other: Machine) -> None:
        end = ("peer", "name", "cable", "netns", str(other._holder.pid))
        self._run("ip", "link", "add", "cable", "type", "veth", *end)
        for machine in (self, other):
            machine._run("ip", "address", "add", f"{machine.address}/24", "dev", "cable")
            machine._run("ip", "link", "set", "cable", "up")
        wait_until(lambda: "LOWER_UP" in self._run("ip", "link", "show", "cable"), "the cable")

    def _run(self, *words: str) -> str:
        command = [*self.inside(), *words]
        return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def can_make_machines() -> bool:
    """Return whether this user may make networks of his own here."""
    try:
        made = subprocess.run(["unshare", *_rights(), *ALONE, "true"], check=False, capture_output=True)
    except FileNotFoundError:
        return False
    return made.returncode == 0


@cache
def _rights() -> tuple[str, ...]:
    """Return how to become one who may make networks; root of the machine need not become it."""
    user = ("--user", "--map-root-user")
    tried = subprocess.run(["unshare", *user, *ALONE, "true"], check=False, capture_output=True)
    return () if tried.returncode and os.geteuid() == 0 else user
