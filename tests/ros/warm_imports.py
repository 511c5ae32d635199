"""What a warm node needs, imported by the process that it is forked from; see `tests.forks`."""

from __future__ import annotations

from launcher.spawn_server.preload import Preload

_ahead = Preload(cold=False)
while _ahead.wait_s is not None:
    _ahead.step()

SHARED = _ahead
