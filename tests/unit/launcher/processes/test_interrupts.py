"""An interrupt before a command is ready for it: it ends, and prints no traceback."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

HOUSE = Path(__file__).parents[4]
RUN = """
try:
    run(work())
except KeyboardInterrupt:
    print("interrupted")
"""
A_LOOP_THAT_IS_INTERRUPTED_WHILE_IT_IS_MADE = """
import asyncio, signal
from launcher.processes.interrupts import run

class Loop(asyncio.SelectorEventLoop):
    def __init__(self):
        signal.raise_signal(signal.SIGINT)
        super().__init__()

class Policy(asyncio.DefaultEventLoopPolicy):
    _loop_factory = Loop

async def work():
    raise AssertionError("the work began")

asyncio.set_event_loop_policy(Policy())
"""
WORK_THAT_IS_INTERRUPTED = """
import asyncio, signal
from launcher.processes.interrupts import run

async def work():
    try:
        signal.raise_signal(signal.SIGINT)
        await asyncio.sleep(60)
    finally:
        print("tidied")

"""
WORK_THAT_RETURNS = """
from launcher.processes.interrupts import run

async def work():
    return 7

print(run(work()))
"""
INTERRUPTED_WHILE_DECK_IS_IMPORTED = """
import builtins, signal, sys
real = builtins.__import__

def interrupted(name, *rest):
    if name == "cli.arguments.commands":
        signal.raise_signal(signal.SIGINT)
    return real(name, *rest)

builtins.__import__ = interrupted
import cli
print("imported")
"""


def ran(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", program],
        cwd=HOUSE,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.parametrize(
    ("program", "printed"),
    [
        (A_LOOP_THAT_IS_INTERRUPTED_WHILE_IT_IS_MADE + RUN, "interrupted\n"),
        (WORK_THAT_IS_INTERRUPTED + RUN, "tidied\ninterrupted\n"),
        (WORK_THAT_RETURNS, "7\n"),
    ],
    ids=["while its loop is made", "while it works", "not at all"],
)
def test_a_command_that_is_interrupted(program: str, printed: str) -> None:
    ended = ran(program)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, printed, "")


def test_deck_that_is_interrupted_while_it_is_imported_says_nothing() -> None:
    ended = ran(INTERRUPTED_WHILE_DECK_IS_IMPORTED)
    assert (ended.returncode, ended.stdout, ended.stderr) == (-signal.SIGINT, "", "")
