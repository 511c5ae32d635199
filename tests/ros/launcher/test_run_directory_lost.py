"""A session whose run directory goes is still reached, and is not started a second time."""

from __future__ import annotations

import asyncio
import json
import shutil
import stat
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from launcher.client.client import attach, running
from launcher.errors import AlreadyRunningError, NotRunningError
from launcher.rundir import run_dir
from launcher.runs.found import supervisors
from tests.deck_process import alive, deck
from tests.ros.supervised import SLEEPER, Launch, running_pid, until_state
from tests.waiting import until, wait_until

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient

pytestmark = pytest.mark.nightly

NODE = {"node": {"exec": SLEEPER}}


def home(client: SupervisorClient) -> Path:
    return run_dir() / client.session.run_id


def supervised_in(client: SupervisorClient) -> Path:
    """Where the session's folder is, as /proc tells."""
    (found,) = [one for one in supervisors() if one.run_id == client.session.run_id]
    return Path(found.place)


async def made_again(client: SupervisorClient) -> Path:
    """Wait until the folder of the session is where it belongs, with all that is in it."""
    folder = home(client)

    def complete() -> bool:
        return (folder / "session.json").is_file() and (folder / "control.sock").is_socket()

    await until(complete, "the folder of the session")
    return folder


@pytest.mark.parametrize("what", ["the whole directory", "the session's folder", "the socket"])
async def test_what_is_removed_is_made_again_and_told(
    start: Launch, tmp_path: Path, what: str
) -> None:
    client = await start(NODE)
    pid = await running_pid(client, "node")
    if what == "the socket":
        (home(client) / "control.sock").unlink()
    else:
        shutil.rmtree(tmp_path / "run" if what == "the whole directory" else home(client))
    folder = await made_again(client)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert stat.S_IMODE((folder / "control.sock").stat().st_mode) == 0o600
    other = await attach("test")
    assert other.nodes["node"].pid == pid
    assert any("is gone" in line.text for line in await other.history(None, 100))
    await other.aclose()
    await client.restart("node")
    await until(lambda: client.nodes["node"].pid not in (pid, None), "another process")
    record = json.loads((folder / "session.json").read_text())
    await until(
        lambda: (
            json.loads((folder / "session.json").read_text())["processes"]["node"][0]
            == client.nodes["node"].pid
        ),
        lambda: f"its new process in the record {record}",
    )


@pytest.mark.cold
async def test_one_whose_directory_was_moved_is_reached_at_once(
    start: Launch, tmp_path: Path
) -> None:
    client = await start(NODE)
    await running_pid(client, "node")
    (tmp_path / "run").rename(tmp_path / "moved")
    other = await attach()
    assert other.session.run_id == client.session.run_id
    await other.aclose()
    assert [session.run_id for session in running()] == [client.session.run_id]
    await made_again(client)
    left = [path for path in (tmp_path / "moved").rglob("*") if path.name != "lock"]
    assert [path for path in left if not path.is_dir()] == [], "nothing that looks like a session"


@pytest.mark.cold
async def test_one_that_finds_no_place_where_it_was_is_reached_by_its_process(
    start: Launch, tmp_path: Path
) -> None:
    """As after logging out: /run/user/UID is gone, and cannot be made by its user."""
    client = await start(NODE)
    await running_pid(client, "node")
    shutil.rmtree(tmp_path / "run")
    (tmp_path / "run").write_text("in the way")
    await until(lambda: supervised_in(client).exists(), "another folder")
    place = supervised_in(client)
    assert not place.is_relative_to(tmp_path / "run")
    assert stat.S_IMODE(place.stat().st_mode) == 0o700
    (tmp_path / "run").unlink()
    other = await attach()
    assert other.session.run_id == client.session.run_id
    await other.shutdown()
    assert not place.exists()
    assert running() == []


def test_up_again_after_the_directory_went_starts_no_second_robot(
    tmp_path: Path, ros_domain: int
) -> None:
    path = tmp_path / "one.yaml"
    path.write_text(json.dumps({"nodes": NODE}))
    assert deck("up", str(path)).process.returncode == 0
    (session,) = running()
    for spoil in (shutil.rmtree, lambda run: run.rename(tmp_path / "moved")):
        spoil(tmp_path / "run")
        again = deck("up", str(path))
        assert again.process.returncode == 1
        assert f"one is already running in domain {ros_domain}" in again.errors[0]
    shutil.rmtree(tmp_path / "run")
    down = deck("down")
    assert (down.process.returncode, down.lines) == (0, ["one stopped, 1 node"])
    wait_until(lambda: not alive(session.supervisor_pid), "its end")


async def test_another_run_directory_hides_no_robot_in_the_same_domain(
    start: Launch, tmp_path: Path, ros_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = await start(NODE)
    await running_pid(first, "node")
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / "another"))
    assert running() == [], "whoever keeps runs apart sees his own"
    with pytest.raises(NotRunningError):
        await attach()
    with pytest.raises(AlreadyRunningError) as refused:
        await start(NODE)
    words = str(refused.value)
    assert str(first.session.supervisor_pid) in words
    assert str(tmp_path / "run") in words
    assert f"domain {ros_domain}" in words
    assert "--domain" in words
    assert first.nodes["node"].state.alive


async def test_two_at_the_same_moment_from_two_directories_are_one(
    start: Launch, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tries = []
    for number in range(4):
        monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / f"run-{number}"))
        tries.append(asyncio.ensure_future(start(NODE, name=f"n{number}")))
        await asyncio.sleep(0)  # It has taken the variable by now.
    results = await asyncio.gather(*tries, return_exceptions=True)
    refused = [result for result in results if isinstance(result, AlreadyRunningError)]
    assert len(refused) == 3, results
    (only,) = [result for result in results if not isinstance(result, BaseException)]
    await until_state(only, "node", only.nodes["node"].state)
