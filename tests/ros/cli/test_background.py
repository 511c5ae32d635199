"""`deck up`, `ps`, `logs`, `down`: a profile in the background, and two at once."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from launcher.client.client import running
from safety.stop_file import KeptStop, StopFile
from safety.stop_record import Stop, StopRecord
from tests.deck_process import DeckProcess, alive, deck
from tests.ros.supervised import end_sessions
from tests.unit.profile_files import written
from tests.waiting import wait_until

ONE = """\
nodes:
  ticker: {exec: [sh, -c, "n=0; while :; do n=$((n+1)); echo tick $n; sleep 0.1; done"]}
  quiet: {exec: [sleep, 100]}
"""
TWO = "nodes: {other: {exec: [sleep, 100]}, quiet: {exec: [sleep, 100]}}"


@pytest.fixture(autouse=True)
async def _domain(ros_domain: int) -> AsyncIterator[int]:
    yield ros_domain
    await end_sessions()


def test_from_up_to_down(tmp_path: Path, ros_domain: int) -> None:
    path = str(written(tmp_path, ONE, "one.yaml"))
    up = deck("up", path)
    assert (up.process.returncode, up.errors) == (0, [])
    assert [line.split()[:2] for line in up.lines[1:4]] == [
        ["NODE", "STATE"],
        ["ticker", "running"],
        ["quiet", "running"],
    ]

    (session,) = json.loads("\n".join(deck("ps", "--json").lines))
    assert (session["name"], session["domain"]) == ("one", ros_domain)
    assert session["foreground"] is False
    pids = [node["pid"] for node in session["nodes"]]
    assert all(map(alive, pids))

    logs = deck("logs", "ticker", "-n", "3")
    assert logs.process.returncode == 0
    numbers = [int(line.split()[-1]) for line in logs.lines]
    assert numbers == list(range(numbers[0], numbers[0] + 3))

    unknown = deck("logs", "tickr")
    assert unknown.process.returncode == 2
    assert unknown.errors == ["no node 'tickr'; there are: ticker, quiet"]

    again = deck("up", path)
    assert again.process.returncode == 1
    assert f"one is already running in domain {ros_domain}" in again.errors[0]

    down = deck("down")
    assert (down.process.returncode, down.lines) == (0, ["one stopped, 2 nodes"])
    assert not any(map(alive, pids))
    assert deck("ps").errors[0].startswith("nothing runs in the background")


def test_where_only_the_supervisor_hangs_ps_names_the_nodes_and_down_ends_them(
    tmp_path: Path, ros_domain: int
) -> None:
    deck("up", str(written(tmp_path, ONE, "one.yaml")))
    (session,) = json.loads("\n".join(deck("ps", "--json").lines))
    pids = {node["node"]: node["pid"] for node in session["nodes"]}
    os.kill(session["supervisor_pid"], signal.SIGSTOP)
    told = deck("ps")
    assert told.process.returncode == 1
    (words,) = told.errors
    assert f"(domain {ros_domain}): the supervisor (pid {session['supervisor_pid']}) does not" in words
    assert all(f"{name} ({pid})" in words for name, pid in pids.items())
    told = deck("ps", "--json")
    (silent,) = json.loads("\n".join(told.lines))
    assert (told.process.returncode, silent["supervisor_answers"]) == (1, False)
    assert {node["node"]: node["pid"] for node in silent["nodes"]} == pids
    down = deck("down")
    assert down.process.returncode == 0
    assert "did not answer; it was killed with all its nodes" in down.errors[0]
    assert not any(map(alive, pids.values()))


def test_a_stop_that_is_remembered_is_told_with_the_way_to_release_it(tmp_path: Path, ros_domain: int) -> None:
    path = str(written(tmp_path, ONE, "one.yaml"))
    told = (
        f"■ EMERGENCY STOP in domain {ros_domain}: its robot does not move until the stop is"
        f" released; `deck watch --domain {ros_domain}`, then Ctrl+R"
    )
    file, record = StopFile(ros_domain, "/safety_stop"), StopRecord().stopped(Stop(1))
    assert file.keep(KeptStop(1.0, "topic"), record) == ""
    assert told in deck("run", path, "--for", "0").errors
    assert told in deck("up", path).errors
    assert told in deck("ps").lines
    (session,) = json.loads("\n".join(deck("ps", "--json").lines))
    assert session["emergency_stop"] is True
    assert file.forget(record.freed()) == ""
    assert told not in deck("ps").lines
    (session,) = json.loads("\n".join(deck("ps", "--json").lines))
    assert session["emergency_stop"] is False


@pytest.mark.parametrize("words", [["logs", "-f"], ["down"]])
def test_a_command_whose_supervisor_is_killed_meanwhile_says_so(tmp_path: Path, words: list[str]) -> None:
    """It hangs, so that the command is sure to wait for it."""
    deck("up", str(written(tmp_path, ONE, "one.yaml")))
    supervisor = running()[0].supervisor_pid
    os.kill(supervisor, signal.SIGSTOP)
    command = DeckProcess(*words)
    wait_until(lambda: is_connected(command.process.pid), "a connection to the supervisor")
    os.kill(supervisor, signal.SIGKILL)
    code = command.finish()
    if words == ["ps"]:
        assert (code, command.lines) == (0, [])
        assert command.errors[0].startswith("nothing runs in the background")
    else:
        assert (code, command.errors) == (1, ["the supervisor does not answer"])


def is_connected(pid: int) -> bool:
    """Whether a process has a connected Unix socket besides the pair that is asyncio's own."""
    connected = {
        words[6] for line in Path("/proc/net/unix").read_text().splitlines() if (words := line.split())[5] == "03"
    }
    links = []
    for held in Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):  # It has closed this one just now.
            links.append(os.readlink(held))  # noqa: PTH115 - no paths
    return len([link for link in links if link[len("socket:[") : -1] in connected]) > 2


def test_two_at_once_are_told_apart_by_name(tmp_path: Path, other_domain: int) -> None:
    deck("up", str(written(tmp_path, ONE, "one.yaml")))
    deck("up", str(written(tmp_path, TWO, "two.yaml")), "--domain", str(other_domain))
    for words in (["down"], ["logs", "quiet"]):
        refused = deck(*words)
        assert refused.process.returncode == 2
        assert refused.errors == ["several profiles run, choose one by name: one, two"]
    assert deck("logs", "other", "-n", "0").process.returncode == 0
    assert deck("logs", "quiet", "--profile", "two").process.returncode == 0
    missing = deck("down", "three")
    assert missing.process.returncode == 1
    assert missing.errors == ["'three' is not running; running: one, two"]
    assert deck("down", "one").lines == ["one stopped, 2 nodes"]
    assert deck("down").lines == ["two stopped, 2 nodes"]


def test_a_second_one_in_the_same_domain_is_refused_where_the_two_collide(tmp_path: Path, ros_domain: int) -> None:
    deck("up", str(written(tmp_path, ONE, "one.yaml")))
    for command in ("up", "run"):
        second = deck(command, str(written(tmp_path, TWO, "two.yaml")))
        assert second.process.returncode == 2
        assert len(second.errors) == 1
        assert f"one is already running in domain {ros_domain}" in second.errors[0]
        assert re.search(r"`--domain \d+` starts another beside it", second.errors[0])
    assert [session.name for session in running()] == ["one"]
