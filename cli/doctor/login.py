"""The effect of logging out: logind may clear /dev/shm while nodes are still running."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cli.doctor.finding import Level, ok, warn
from text.i18n import _

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from cli.doctor.finding import Finding

FIRST_HUMAN_UID = 1000
"""logind leaves the IPC objects of system users alone."""
SETTING = re.compile(r"^\s*RemoveIPC\s*=\s*(\w+)", re.MULTILINE | re.IGNORECASE)
FOLDERS = ("/usr/lib/systemd", "/run/systemd", "/etc/systemd")


@dataclass(frozen=True)
class LoginFacts:
    """Facts about the login session."""

    logind: bool = False
    """Whether systemd-logind manages logins on this machine."""
    remove_ipc: bool = True
    """Its setting; the default is yes."""
    lingers: bool = False
    """Whether this user's processes and IPC objects survive logging out."""
    uid: int = 1000


def collect() -> LoginFacts:
    user = os.environ.get("USER", "")
    return LoginFacts(
        logind=Path("/run/systemd/system").is_dir(),
        remove_ipc=setting(_files()),
        lingers=bool(user) and Path("/var/lib/systemd/linger", user).exists(),
        uid=os.getuid(),
    )


def diagnose(facts: LoginFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    key = "login.remove_ipc"
    if not facts.logind:
        return []
    if not facts.remove_ipc or facts.lingers or facts.uid < FIRST_HUMAN_UID:
        return [ok(key, _("logging out does not affect running nodes"))]
    return [
        warn(
            key,
            _("RemoveIPC: logging out clears /dev/shm, and nodes started by `deck up` lose each other"),
            _("run: loginctl enable-linger, or set RemoveIPC=no in /etc/systemd/logind.conf"),
        )
    ]


def before_logout(facts: LoginFacts, environ: Mapping[str, str]) -> list[str]:
    """Return warnings, a line each, for a user who leaves nodes running in this login."""
    if not environ.get("XDG_SESSION_ID"):
        return []  # Not a login session of logind: it cannot end.
    found = [finding for finding in diagnose(facts) if finding.level is Level.WARN]
    return [line for finding in found for line in (finding.text, finding.fix)]


def setting(texts: Iterable[str]) -> bool:
    """Return the value of RemoveIPC in these files; the last one counts."""
    value = "yes"
    for text in texts:
        for match in SETTING.finditer(text):
            value = match.group(1)
    return value.lower() in ("yes", "true", "on", "1")


def _files() -> list[str]:
    """Return the texts of logind's configuration files in order of precedence, lowest first."""
    paths = [Path(folder, "logind.conf") for folder in reversed(FOLDERS)]
    main = next((path for path in paths if path.is_file()), None)
    parts = {path.name: path for folder in FOLDERS for path in Path(folder, "logind.conf.d").glob("*.conf")}
    files = [*([main] if main else []), *(parts[name] for name in sorted(parts))]
    return [_text(path) for path in files]


def _text(path: Path) -> str:
    try:
        return path.read_text(errors="replace")
    except OSError:
        return ""
