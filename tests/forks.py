"""Processes forked from one that has imported ahead what they need; each test worker has one."""

from __future__ import annotations

import multiprocessing

FORKS = multiprocessing.get_context("forkserver")
FORKS.set_forkserver_preload(
    [
        *("cli.main", "cli.listing", "cli.background", "cli.run", "cli.record", "cli.replay"),
        "tests.ros.warm_imports",
    ]
)
