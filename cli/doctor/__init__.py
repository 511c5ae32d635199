"""`deck doctor`: what is installed, what is missing, and how to fix it.

Each module here examines one thing: `collect` gathers plain facts, `diagnose` only interprets them,
so that it can be tested with the facts of any machine. Elsewhere `command` is used by the command
line, and `finding` and `serial_ports` by `cli.preflight`.
"""

from __future__ import annotations

from importlib import import_module

from cli.doctor.finding import Finding, Level

__all__ = ["Finding", "Level", "examine"]

THINGS = (
    *("python", "ros", "network", "terminal"),
    *("serial_ports", "media", "groups", "power", "runs", "model"),
    "llama",
)


def examine() -> list[Finding]:
    found: list[Finding] = []
    for thing in THINGS:
        module = import_module(f"{__name__}.{thing}")
        found += module.diagnose(module.collect())
    return found
