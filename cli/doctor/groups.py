"""The groups that a user of the real robot needs: for serial ports, cameras and sound."""

from __future__ import annotations

import grp
import os
import pwd
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cli.doctor.finding import ok, warn
from cli.doctor.power import ROOT
from cli.doctor.power import collect as collect_power
from text.i18n import _

if TYPE_CHECKING:
    from pathlib import Path

    from cli.doctor.finding import Finding

NEEDED = ("dialout", "video", "audio")


@dataclass(frozen=True)
class GroupFacts:
    """The user's groups, and those that the devices need."""

    pi: bool = False
    """Whether this is a Raspberry Pi, and so most likely the robot itself."""
    user: str = ""
    uid: int = 1000
    existing: tuple[str, ...] = NEEDED
    """Those of NEEDED that exist on this machine."""
    mine: tuple[str, ...] = ()
    """Groups of this process: one joined recently only counts after logging in again."""
    written: tuple[str, ...] = ()
    """The user's groups from the next login on."""


def collect(root: Path = ROOT) -> GroupFacts:
    groups = grp.getgrall()
    try:
        user = pwd.getpwuid(os.getuid()).pw_name
    except KeyError:
        user = os.environ.get("USER", "")
    gids = {os.getgid(), *os.getgroups()}
    return GroupFacts(
        pi=bool(collect_power(root, lambda: "").pi),
        user=user,
        uid=os.getuid(),
        existing=tuple(name for name in NEEDED if any(each.gr_name == name for each in groups)),
        mine=tuple(each.gr_name for each in groups if each.gr_gid in gids),
        written=tuple(each.gr_name for each in groups if user in each.gr_mem),
    )


def diagnose(facts: GroupFacts) -> list[Finding]:
    """Report what is all right and what is not; only the robot needs these groups."""
    missing = [name for name in facts.existing if name not in facts.mine]
    if facts.uid == 0 or not facts.pi or not missing:
        return [] if not facts.pi else [ok("groups", _("you may use serial ports, camera, sound"))]
    text = _("you are not in: {groups}").format(groups=", ".join(missing))
    if set(missing) <= set(facts.written):
        return [warn("groups", text, _("log out and in again: you have already been added"))]
    fix = _("run: sudo usermod -aG {group} {user}, then log out and in again")
    fix = fix.format(group=",".join(missing), user=facts.user or "$USER")
    return [warn("groups", text, fix)]
