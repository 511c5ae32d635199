"""The viewer's page in a real browser: what it shows, and what it asks for."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import psutil
import pytest

from tests.browser import Browser
from tests.ros.view.conftest import RED, Shown
from tests.waiting import wait_until

if TYPE_CHECKING:
    from numpy.typing import NDArray

pytestmark = [pytest.mark.machine("browser"), pytest.mark.nightly]
WITHIN_S = 60.0


def number_on(picture: NDArray[np.uint8]) -> int | None:
    """Return the number that the camera's picture on the page has, None if there is no picture."""
    red = (picture == RED).all(axis=2)
    rows, columns = np.nonzero(red)
    # Frames have red axes, too.
    if len(rows) < 400:
        return None
    row = int(np.median(rows))
    right = int(columns[rows == row].max())
    grey = picture[row, right + 10]
    return int(grey[0]) if grey.min() == grey.max() else None


@pytest.mark.slow
def test_it_shows_what_the_camera_sees_now_and_asks_nobody_else(shown: Shown, tmp_path: Path) -> None:
    """Its colours to the pixel, and later a later picture; nothing leaves this machine."""
    with Browser(tmp_path, (800, 500)) as browser:
        browser.open(shown.url)
        first = wait_until(lambda: number_on(browser.picture()), "the picture", WITHIN_S, 0.3)
        later = wait_until(
            lambda: (now := number_on(browser.picture())) != first and now, "a later picture", WITHIN_S, 0.3
        )
        assert first != later
        outside = browser.evaluate("fetch('https://example.com/').then(() => 'let out', () => 'refused')")
        assert outside == "refused"
        assert "re_viewer_bg.wasm" in "".join(browser.requests)
        # What the policy refuses is not even asked for.
        assert [url for url in browser.requests if not url.startswith("http://127.0.0.1:")] == []
        assert any("https://example.com/" in words for words in browser.refused)


def test_nobody_but_this_machine_can_reach_it(shown: Shown) -> None:
    """Deck's process and Rerun's: where they listen, and whom they are connected with."""
    own = psutil.Process(shown.process.process.pid)
    found = [connection for one in (own, *own.children(recursive=True)) for connection in one.net_connections("tcp")]
    listening = {one.laddr.ip for one in found if one.status == psutil.CONN_LISTEN}
    assert listening == {"127.0.0.1"}
    assert {one.raddr.ip for one in found if one.raddr} <= {"127.0.0.1"}
    wait_until(lambda: len(own.children()) == 2, "Rerun and the observer, and nobody else")
