"""The command line: `deck`, `deck run`, `deck list` and the rest.

From outside: `main` alone. A module is a command, or what commands share; `main` imports the one
that is asked for.
"""

from cli.main import main

__all__ = ["main"]
