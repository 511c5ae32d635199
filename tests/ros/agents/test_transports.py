"""`deck mcp` as a program: what it writes, who gets in by HTTP, and how it ends."""

from __future__ import annotations

import json
import os
import resource
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal

import httpx2
import mcp_types as types
import pytest
from mcp.client.client import Client
from mcp.client.streamable_http import streamable_http_client

from tests.deck_process import DeckProcess, deck
from tests.ros.agents.robots import GATED, Agent, running
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

HELLO = {
    "jsonrpc": "2.0",
    "id": 1,
    "method": "initialize",
    "params": {
        "protocolVersion": "2025-06-18",
        "capabilities": {},
        "clientInfo": {"name": "raw", "version": "1"},
    },
}


@pytest.fixture(autouse=True)
def _own_config(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))


@contextmanager
def stdio(*options: str) -> Iterator[subprocess.Popen[bytes]]:
    """The program with pipes."""
    process = subprocess.Popen(
        [sys.executable, "-m", "tui", "mcp", *options],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                stream.close()


def greeted(process: subprocess.Popen[bytes]) -> dict[str, Any]:
    """Say hello; return the answer."""
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(json.dumps(HELLO).encode() + b"\n")
    process.stdin.flush()
    answer: dict[str, Any] = json.loads(process.stdout.readline())
    return answer


async def test_standard_output_is_the_protocol_alone(tmp_path: Path, ros_domain: int) -> None:
    async with running(tmp_path, ros_domain, {"sonar": GATED["sonar"]}):
        with stdio() as process:
            server = greeted(process)["result"]["serverInfo"]
            assert (server["name"], server["version"]) == ("deck", version("deck-robot"))
            assert process.stdin is not None
            call = {"method": "tools/call", "params": {"name": "look", "arguments": {}}}
            lines = (
                {"jsonrpc": "2.0", "method": "notifications/initialized"},
                {"jsonrpc": "2.0", "id": 2, **call},
            )
            process.stdin.write(
                b"not json\n" + b"".join(json.dumps(x).encode() + b"\n" for x in lines)
            )
            process.stdin.flush()
            assert process.stdout is not None
            while (line := json.loads(process.stdout.readline())).get("id") != 2:
                pass
            assert "robot" in line["result"]["content"][0]["text"]
            process.stdin.close()
            rest = process.stdout.read()
            assert process.wait(20) == 0
        assert all(json.loads(line) for line in rest.splitlines())


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_though_nobody_closes_its_input(
    ros_domain: int, number: signal.Signals
) -> None:
    del ros_domain
    with stdio() as process:
        greeted(process)
        process.send_signal(number)
        assert process.wait(20) == 0


def test_wrong_requests_are_usage_errors(ros_domain: int) -> None:
    del ros_domain
    for options in (("--approve", "perhaps"), ("--port", "70000"), ("--port", "x"), ("--what",)):
        ended = deck("mcp", *options)
        assert ended.process.returncode == 2, options
        assert ended.lines == []


def test_the_token_is_shown_when_it_is_asked_for_and_the_file_is_private(tmp_path: Path) -> None:
    shown = deck("mcp", "--show-token")
    assert shown.process.returncode == 0
    (token,) = shown.lines
    file = tmp_path / "config" / "deck" / "mcp-token"
    assert file.read_text() == token + "\n"
    assert deck("mcp", "--show-token").lines == [token]
    file.chmod(0o644)
    refused = deck("mcp", "--http", "--port", "0")
    assert refused.process.returncode == 2
    assert "can be read by others" in refused.errors[0]
    assert token not in "".join(refused.errors)


@contextmanager
def http() -> Iterator[tuple[DeckProcess, str, str]]:
    """The program, its address, and the token."""
    (token,) = deck("mcp", "--show-token").lines
    process = DeckProcess("mcp", "--http", "--port", "0", "--lang", "en")
    try:
        said = wait_until(lambda: process.errors[:1], "its address")
        yield process, said[0].split()[0], token
        process.signal(signal.SIGINT)
        assert process.finish() == 0
        assert process.lines == []
        assert token not in "".join(process.errors)
    finally:
        process.close()


def status(address: str, **headers: str) -> int:
    """Return the status of a request."""
    body = json.dumps(HELLO).encode()
    given = {
        "Content-Type": "application/json",
        "Accept": "application/json, text/event-stream",
        **{name.replace("_", "-"): value for name, value in headers.items()},
    }
    try:
        with urllib.request.urlopen(urllib.request.Request(address, body, given), timeout=20) as it:
            return int(it.status)
    except urllib.error.HTTPError as error:
        return error.code


def test_only_who_knows_the_token_gets_in_and_no_web_page(ros_domain: int) -> None:
    del ros_domain
    with http() as (_process, address, token):
        right = f"Bearer {token}"
        assert address.startswith("http://127.0.0.1:")
        assert status(address) == 401
        assert status(address, Authorization="Bearer wrong") == 401
        assert status(address, Authorization=token) == 401
        assert status(address + f"?token={token}") == 401
        assert status(address, Authorization=right) == 200
        assert status(address, Authorization=right, Host="evil.example") == 421
        assert status(address, Authorization=right, Origin="http://evil.example") == 403


def half_open(address: str, count: int) -> list[socket.socket]:
    """Begin requests without a token, as fast as one can, and end none."""
    port = int(address.rpartition(":")[2].partition("/")[0])
    begun = []
    for _number in range(count):
        one = socket.create_connection(("127.0.0.1", port), timeout=30)
        begun.append(one)
        with suppress(OSError):  # It may have made way already.
            one.sendall(b"POST /mcp HTTP/1.1\r\nHost: 127")
    return begun


def test_half_open_requests_lock_no_agent_out(ros_domain: int) -> None:
    """As many as the server may have descriptors, and more; none of them stays for good."""
    del ros_domain
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(4096, hard), hard))
    with http() as (_process, address, token):
        begun = half_open(address, 1100)
        try:
            assert status(address, Authorization=f"Bearer {token}") == 200
            # The youngest is ended too, once its request has not come in time.
            begun[-1].settimeout(60)
            with suppress(ConnectionResetError):
                assert begun[-1].recv(1) == b""
        finally:
            for one in begun:
                one.close()
            resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


async def test_agents_by_http_look_at_the_robot(tmp_path: Path, ros_domain: int) -> None:
    async with running(tmp_path, ros_domain, {"sonar": GATED["sonar"]}):
        with http() as (_process, address, token):
            headers = {"Authorization": f"Bearer {token}"}
            async with httpx2.AsyncClient(headers=headers, timeout=30) as web:
                modes: tuple[tuple[str, Literal["auto", "legacy"]], ...]
                modes = (("first", "auto"), ("second", "legacy"))
                for name, mode in modes:
                    info = types.Implementation(name=name, version="1")
                    transport = streamable_http_client(address, http_client=web)
                    async with Client(transport, client_info=info, mode=mode) as client:
                        assert (await Agent(client).call("look"))["session"] == "robot"


def test_a_port_that_is_taken_is_said(ros_domain: int) -> None:
    del ros_domain
    with http() as (_process, address, _token):
        port = address.rpartition(":")[2].partition("/")[0]
        ended = deck("mcp", "--http", "--port", port, "--lang", "en")
        assert ended.process.returncode == 2
        assert f"port {port} cannot be listened on" in ended.errors[0]


def test_a_person_who_starts_it_in_a_terminal_is_told_what_it_is_for(ros_domain: int) -> None:
    del ros_domain
    ours, theirs = os.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "tui", "mcp", "--lang", "en"],
        stdin=theirs,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    os.close(theirs)
    out, errors = process.communicate(timeout=30)
    os.close(ours)
    assert (process.returncode, out) == (2, b"")
    assert b"--http" in errors
