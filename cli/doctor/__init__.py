"""`deck doctor`: what is there, what is missing, and how to fix it.

Each module here looks at one thing: `look` gathers plain facts, `judge` says what they mean and
does nothing else, so that it can be tested with facts of any machine.
"""

from __future__ import annotations

from importlib import import_module

from cli.doctor.finding import Finding, Level

__all__ = ["Finding", "Level", "examine"]

THINGS = (
    *("python", "ros", "network", "terminal"),
    *("serial_ports", "media", "groups", "power", "shared_memory", "login", "runs"),
)


def examine() -> list[Finding]:
    """Look at everything."""
    found: list[Finding] = []
    for thing in THINGS:
        module = import_module(f"{__name__}.{thing}")
        found += module.judge(module.look())
    return found
