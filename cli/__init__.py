"""The command line: `deck`, `deck run`, `deck list` and the rest."""

from cli.main import main

__all__ = ["main"]
