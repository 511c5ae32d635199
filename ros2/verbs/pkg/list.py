"""`ros2 pkg list`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2.packages import packages

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

SUMMARY = "Output a list of available packages"


def arguments(_parser: ArgumentParser) -> None:
    """There are none."""


def main(_args: Namespace) -> None:
    for name in sorted(packages()):
        print(name)
