"""Who is in the domain by the kernel's word, set against who has been found there, and how far.

A list of the graph is complete when every participant that has ports on this machine has been
found, and when each that was found has told all it has. Of other machines nothing can be known;
each of their participants announces itself within `NETWORK_S`.
"""

from __future__ import annotations

import os
import socket
import struct
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from graph.ros import FAST_DDS, FAST_DDS_VARIABLES, LOCALHOST_ONLY, PEERS, RANGE
from launcher.processes.table import NODE_MARK, command_line, read_environment, read_process
from text.i18n import localized
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from graph.participants import Attendance
    from launcher.domain.participants import LocalParticipant
    from text.sentences import Words

ANSWERED_WITHIN_S = 5.0
"""So long may a node that is there take to answer, unless told otherwise."""
NETWORK_S = 3.3
"""Fast DDS announces a participant each 3 s, where Deck has not set it otherwise."""
HOST = 4
"""Bytes of a participant's GUID that say vendor and machine, in Fast DDS; its process follows."""
VENDOR = 2
LOW_BITS = 0xFFFF
_PROCESS = struct.Struct("<H")
SHOWN = 3
"""So many of those who are missing are named."""
LONGEST_NAME = 60
"""Characters of a command line."""


@dataclass(frozen=True)
class Missing:
    """Who is there and has not told all."""

    pids: tuple[int, ...] = ()
    """Their processes, as often as they have participants; 0 for one that is not known."""
    elsewhere: int = 0
    """How many are on other machines."""

    def __bool__(self) -> bool:
        return bool(self.pids or self.elsewhere)

    def without(self, pids: Iterable[int]) -> Missing:
        """Leave out these processes."""
        left = set(pids)
        return Missing(tuple(pid for pid in self.pids if pid not in left), self.elsewhere)


def missing(attendance: Attendance, here: Sequence[LocalParticipant]) -> Missing:
    """Compare who has been found with who has ports on this machine.

    A participant's GUID names its process by the lower 16 bits of the pid.
    """
    host = _own_host(attendance)
    found = Counter(_process(one) for one in attendance.found if one[:HOST] == host)
    pids = {one.pid & LOW_BITS: one.pid for one in here if one.pid}
    wanted = Counter(one.pid & LOW_BITS for one in here if one.pid)
    absent = [pids[number] for number in (wanted - found).elements()]
    absent += [one.pid for one in here if not one.pid]
    # Found, and not known to the kernel: in another container, of another make, or just gone.
    others = sum((found - wanted).values())
    foreign = sum(one[:VENDOR] != host[:VENDOR] for one in attendance.found)
    absent = absent[: max(len(absent) - others - foreign, 0)]
    half = [one for one in attendance.partly if one[:HOST] == host]
    told_half = sorted(pids.get(_process(one), 0) for one in half)
    # Who has left a moment ago will not tell any more.
    left = min(told_half.count(0), max(sum(found.values()) - len(here), 0)) if here else 0
    return Missing((*absent, *told_half[left:]), len(attendance.partly) - len(half))


def _own_host(attendance: Attendance) -> bytes:
    ours = os.getpid() & LOW_BITS
    own = (one for one in attendance.found if _process(one) == ours)
    return next(own, b"\0" * HOST)[:HOST]


def _process(participant: bytes) -> int:
    """Return the lower 16 bits of the pid. Source: Fast DDS, GuidUtils.hpp."""
    number: int = _PROCESS.unpack_from(participant, HOST)[0]
    return number


def stopped(pids: Iterable[int]) -> list[int]:
    """Return those processes that are halted, as by Ctrl-Z, and tell nothing till they go on."""
    states = {pid: read_process(pid) for pid in set(pids) if pid}
    return [pid for pid, process in states.items() if process and process.state in "Tt"]


def is_wide(environ: Mapping[str, str] = os.environ) -> bool:
    """Return whether participants of other machines can be found, by ROS's variables."""
    if (
        environ.get(LOCALHOST_ONLY) == "1"
        or environ.get(FAST_DDS_VARIABLES[0]) == str(FAST_DDS)
        or not _has_network()
    ):
        return False
    reach = environ.get(RANGE, "").upper()
    return reach not in ("LOCALHOST", "OFF") or (reach != "OFF" and bool(environ.get(PEERS)))


def is_off(environ: Mapping[str, str] = os.environ) -> bool:
    """Return whether nobody but this process is to be found."""
    return environ.get(RANGE, "").upper() == "OFF" and environ.get(LOCALHOST_ONLY) != "1"


def _has_network() -> bool:
    return any(name != "lo" for _, name in socket.if_nameindex())


def words(who: Missing, domain: int) -> Words:
    """Say who has not told all."""
    known = [pid for pid in who.pids if pid]
    rest = (
        (say("{n} more", n=len(known) - SHOWN), len(known) - SHOWN),
        (say("{n} of other users or containers", n=who.pids.count(0)), who.pids.count(0)),
        (say("{n} on other machines", n=who.elsewhere), who.elsewhere),
    )
    names = [_name(pid) for pid in known[:SHOWN]] + [each for each, n in rest if n > 0]
    return say(
        "this may not be all: nothing, or not everything, has been heard in domain {domain} from {who}",
        domain=domain,
        who=", ".join(map(localized, names)),
    )


def _name(pid: int) -> Words:
    program = read_environment(pid, NODE_MARK) or command_line(pid)[:LONGEST_NAME]
    if stopped([pid]):
        return say("{program} (pid {pid}, halted)", program=program, pid=pid)
    return say("{program} (pid {pid})", program=program, pid=pid)
