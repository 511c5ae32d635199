"""Tests get domains in which nothing stands in their way, and leave nothing in them."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.domains import DOMAINS, SPARE, DomainPool


@pytest.fixture
def shared_memory(tmp_path: Path) -> Path:
    folder = tmp_path / "shm"
    folder.mkdir()
    return folder


@pytest.fixture
def pool(tmp_path: Path, shared_memory: Path) -> Iterator[DomainPool]:
    pool = DomainPool(tmp_path / "domains", shared_memory)
    yield pool
    pool.let_go()


def make_port(folder: Path, domain: int) -> Path:
    """Make what a killed node leaves."""
    port = folder / f"fastrtps_port{7411 + 250 * domain}"
    port.write_bytes(b"\2".ljust(64, b"\0"))
    port.with_name(f"{port.name}_el").touch()
    return port


def test_where_another_user_has_ports_is_the_last_choice(
    pool: DomainPool, shared_memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for domain in (*DOMAINS, *SPARE):
        if domain != 77:
            make_port(shared_memory, domain)
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert pool.take() == 77
    assert pool.take() in range(1, 102)


def test_where_a_robot_runs_is_the_last_choice(pool: DomainPool, shared_memory: Path) -> None:
    port = make_port(shared_memory, 1)
    with port.with_name(f"{port.name}_el").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        assert pool.take() == 2
    taken = [pool.take() for _ in DOMAINS[1:]]
    assert taken[-1] == 1


def test_each_is_held_once_and_comes_back_late(pool: DomainPool) -> None:
    first, second = pool.take(), pool.take()
    pool.let_go(first)
    assert (first, second, pool.take()) == (1, 2, 3)


def test_ports_of_killed_nodes_go_with_their_domain(pool: DomainPool, shared_memory: Path) -> None:
    domain = pool.take()
    dead, others = make_port(shared_memory, domain), make_port(shared_memory, domain + 1)
    alive = dead.with_name(f"fastrtps_port{7413 + 250 * domain}")
    alive.write_bytes(dead.read_bytes())
    with alive.with_name(f"{alive.name}_el").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        pool.let_go(domain)
        left = {path.name for path in shared_memory.iterdir() if not path.name.endswith("_el")}
        assert left == {others.name, alive.name}


def test_ports_of_a_run_that_was_killed_go_before_a_test_begins(
    pool: DomainPool, shared_memory: Path
) -> None:
    dead = make_port(shared_memory, 1)
    assert pool.take() == 1
    assert not dead.exists()


def test_runs_of_two_users_have_no_domain_in_common(tmp_path: Path) -> None:
    """Each has a folder of its own, and may not write into the files of the other."""
    first, second = (
        DomainPool(tmp_path / user, tmp_path, f"deck-test-{os.getpid()}") for user in ("a", "b")
    )
    taken = {first.take() for _ in range(3)}
    try:
        assert not taken & {second.take() for _ in range(3)}
        first.let_go()
        assert taken & {second.take() for _ in range(len(DOMAINS) - 3)}
    finally:
        second.let_go()


def test_semaphores_of_ports_go_with_them(pool: DomainPool, shared_memory: Path) -> None:
    domain = pool.take()
    first = 7411 + 250 * domain
    for port in (first, first + 2, first + 250):
        (shared_memory / f"sem.fastrtps_port{port}_mutex").touch()
    (shared_memory / f"fastrtps_port{first + 2}").touch()
    pool.let_go(domain)
    assert sorted(path.name for path in shared_memory.iterdir()) == [
        f"fastrtps_port{first + 2}",
        f"sem.fastrtps_port{first + 2}_mutex",
        f"sem.fastrtps_port{first + 250}_mutex",
    ]


def test_where_others_are_everywhere_there_are_domains_to_spare(
    pool: DomainPool, shared_memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for domain in DOMAINS:
        (shared_memory / f"sem.fastrtps_port{7411 + 250 * domain}_mutex").touch()
    us = os.geteuid()
    monkeypatch.setattr("tests.domains.os.geteuid", lambda: us + 1)
    assert pool.take() in SPARE
