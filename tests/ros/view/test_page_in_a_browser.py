"""The viewer's page in a real browser: what it shows, and what it asks for."""

from __future__ import annotations

import subprocess
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.request import Request, urlopen

import numpy as np
import psutil
import pytest

from tests.browser import Browser
from tests.ros.view.conftest import CAMERA, HEIGHT, RED, WIDTH, Shown
from tests.waiting import wait_until
from view.installed import rerun_program

if TYPE_CHECKING:
    from numpy.typing import NDArray

pytestmark = [pytest.mark.machine("browser"), pytest.mark.nightly]
PICTURES = 15
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
def test_it_shows_what_the_camera_sees_now_and_asks_nobody_else(
    shown: Shown, tmp_path: Path
) -> None:
    """Its colours to the pixel, and later a later picture; nothing leaves this machine."""
    with Browser(tmp_path, (800, 500)) as browser:
        browser.open(shown.url)
        first = wait_until(lambda: number_on(browser.picture()), "the picture", WITHIN_S, 0.3)
        later = wait_until(
            lambda: (now := number_on(browser.picture())) != first and now,
            "a later picture",
            WITHIN_S,
            0.3,
        )
        assert first != later
        outside = browser.evaluate(
            "fetch('https://example.com/').then(() => 'let out', () => 'refused')"
        )
        assert outside == "refused"
        assert "re_viewer_bg.wasm" in "".join(browser.requests)
        # What the policy refuses is not even asked for.
        assert [url for url in browser.requests if not url.startswith("http://127.0.0.1:")] == []
        assert any("https://example.com/" in words for words in browser.refused)


@pytest.mark.filterwarnings("ignore:RRD file has no footer")
def test_ten_pictures_a_second_arrive_in_order(shown: Shown, tmp_path: Path) -> None:
    from rerun.chunk import RrdReader

    saved = tmp_path / "saved.rrd"
    source = f"rerun+http://127.0.0.1:{data_port(shown)}/proxy"
    before = shown.camera.number
    command = (
        *(str(rerun_program()), "--bind", "127.0.0.1", "--port", "auto"),
        *("--connect", source, "--save", str(saved)),
    )
    with (tmp_path / "log").open("wb") as log:
        saving = subprocess.Popen(command, stdout=log, stderr=log)
        try:
            wait_until(lambda: shown.camera.number >= before + PICTURES, "the pictures")
        finally:
            saving.terminate()
            saving.wait()
    path = f"/pictures{CAMERA}"
    numbers: list[int] = []
    for chunk in RrdReader(saved).stream():
        if str(chunk.entity_path) == path:
            numbers += [picture[-1] for picture in pictures_of(chunk)]
    steps = [(later - earlier) % 256 for earlier, later in pairwise(numbers)]
    assert all(0 < step < 128 for step in steps)
    # A stalled machine may lose some: the queue of a camera is short.
    assert len(numbers) > 0.6 * sum(steps)
    assert len(numbers) > PICTURES // 2


def pictures_of(chunk: object) -> list[bytes]:
    """Return the pixels of the pictures in a part of a recording, in order."""
    batch = chunk.to_record_batch()  # type: ignore[attr-defined]
    (name,) = (one for one in batch.schema.names if one.endswith("buffer"))
    found = [bytes(row[0]) for row in batch.column(name).to_pylist()]
    assert all(len(one) == 3 * WIDTH * HEIGHT for one in found)
    return found


def test_nobody_but_this_machine_can_reach_it(shown: Shown) -> None:
    """Deck's process and Rerun's: where they listen, and whom they are connected with."""
    own = psutil.Process(shown.process.process.pid)
    found = [
        connection
        for one in (own, *own.children(recursive=True))
        for connection in one.net_connections("tcp")
    ]
    listening = {one.laddr.ip for one in found if one.status == psutil.CONN_LISTEN}
    assert listening == {"127.0.0.1"}
    assert {one.raddr.ip for one in found if one.raddr} <= {"127.0.0.1"}
    wait_until(lambda: len(own.children()) == 2, "Rerun and the observer, and nobody else")


@pytest.mark.parametrize(
    ("site", "allowed"), [("http://127.0.0.1:9090", True), ("https://example.com", False)]
)
def test_other_sites_in_the_browser_may_not_read_the_data(
    shown: Shown, site: str, *, allowed: bool
) -> None:
    asked = Request(
        f"http://127.0.0.1:{data_port(shown)}/",
        method="OPTIONS",
        headers={"Origin": site, "Access-Control-Request-Method": "POST"},
    )
    with urlopen(asked) as answer:
        assert (answer.headers["Access-Control-Allow-Origin"] == site) == allowed


def data_port(shown: Shown) -> int:
    """Return the port that the page reads from."""
    with urlopen(shown.url) as page:
        return int(page.url.partition("127.0.0.1%3A")[2].partition("%2F")[0])
