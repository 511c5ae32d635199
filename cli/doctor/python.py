"""Python, the machine, and the packages that Deck is made of."""

from __future__ import annotations

import platform
import sys
from dataclasses import dataclass
from importlib import metadata
from typing import TYPE_CHECKING

from cli.doctor.finding import fail, ok, warn
from text.i18n import _

if TYPE_CHECKING:
    from collections.abc import Mapping

    from cli.doctor.finding import Finding

FIRST, AFTER_LAST = (3, 10), (3, 14)
DISTRIBUTION = "deck-robot"
PACKAGES = ("textual", "pydantic", "PyYAML", "psutil", "numpy", "pyserial", "setproctitle")
"""Distributions without which the program or one of its packages cannot be imported."""


@dataclass(frozen=True)
class PythonFacts:
    """The Python and the packages found."""

    version: tuple[int, int, int]
    executable: str
    system: str
    """`Linux`."""
    machine: str
    """Such as `x86_64` or `aarch64`."""
    installed: Mapping[str, str]
    """Distribution to version, for those of PACKAGES that are installed."""
    textual_wanted: str = ""
    """The version that Deck requires, empty if it is not known."""


def collect() -> PythonFacts:
    installed = {}
    for name in PACKAGES:
        version = _version(name)
        if version:
            installed[name] = version
    return PythonFacts(
        version=(sys.version_info[0], sys.version_info[1], sys.version_info[2]),
        executable=sys.executable,
        system=platform.system(),
        machine=platform.machine(),
        installed=installed,
        textual_wanted=_pinned("textual"),
    )


def diagnose(facts: PythonFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    return [_python(facts), _machine(facts), *_packages(facts), _textual(facts)]


def _python(facts: PythonFacts) -> Finding:
    version = ".".join(map(str, facts.version))
    text = _("Python {version} ({path})").format(version=version, path=facts.executable)
    if FIRST <= facts.version[:2] < AFTER_LAST:
        return ok("python", text)
    return fail("python", text, _("use Python 3.10 to 3.13: make setup PYTHON=python3.12"))


def _machine(facts: PythonFacts) -> Finding:
    text = f"{facts.system} {facts.machine}"
    if facts.system != "Linux":
        return fail("machine", text, _("Deck runs on Linux; on Windows inside WSL 2"))
    return ok("machine", text)


def _packages(facts: PythonFacts) -> list[Finding]:
    missing = [name for name in PACKAGES if name not in facts.installed]
    if not missing:
        return []
    names = " ".join(missing)
    text = _("not installed: {names}").format(names=names)
    return [fail("packages", text, _("run: make setup"))]


def _textual(facts: PythonFacts) -> Finding:
    version = facts.installed.get("textual", "")
    if facts.textual_wanted in ("", version):
        return ok("textual", f"Textual {version}")
    return warn(
        "textual",
        _("Textual {version}, but Deck needs {wanted}").format(version=version or "-", wanted=facts.textual_wanted),
        f"pip install textual=={facts.textual_wanted}",
    )


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return ""


def _pinned(name: str) -> str:
    try:
        wishes = metadata.requires(DISTRIBUTION) or []
    except metadata.PackageNotFoundError:
        return ""
    pins = (wish.partition(";")[0].partition("==") for wish in wishes)
    return next((version.strip() for found, _eq, version in pins if found.strip() == name), "")
