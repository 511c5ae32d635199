"""Pictures cost nothing where none are shown, and little where they are."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import pytest

from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from tests.ros.observing import ROOT, Peer, Watcher, let_updates_come
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

RAW = "/eye/image_raw"
BLACK = {
    "header": {"frame_id": "eye_link"},
    "height": 2,
    "width": 2,
    "step": 6,
    "encoding": "rgb8",
    "data": [0] * 12,
}
JPEG = {"header": {"frame_id": "eye_link"}, "format": "jpeg", "data": [255, 216, 255]}


@pytest.fixture
def camera(module_domain: int) -> Iterator[Peer]:
    peer = Peer("eye", module_domain)
    peer.advertise(RAW, type_name=IMAGE)
    peer.repeat(RAW, value=BLACK, hz=20)
    yield peer
    peer.close()


@pytest.fixture
def watcher(module_watcher: Watcher) -> Iterator[Watcher]:
    module_watcher.samples.pop(RAW, None)
    yield module_watcher
    module_watcher.observer.watch_pictures(())
    module_watcher.observer.measure(all_topics=False)


def kinds(watcher: Watcher) -> set[str]:
    return {sample.type_name for sample in watcher.samples.get(RAW, ())}


@pytest.mark.usefixtures("camera")
def test_a_screen_without_pictures_takes_none(watcher: Watcher) -> None:
    watcher.observer.measure(all_topics=True, images=False)
    watcher.wait_for("/parameter_events", lambda row: row.measured, "is measured")
    row = watcher.wait_for(RAW, lambda row: row.publishers == 1, "is there")
    assert not row.measured
    watcher.observer.watch_pictures([RAW])
    watcher.wait_for(RAW, lambda row: row.measured and row.frame_id, "is looked at")
    watcher.observer.watch_pictures(())
    row = watcher.wait_for(RAW, lambda row: not row.measured, "is let go at once")
    assert row.frame_id == "eye_link"


def test_compressed_pictures_are_taken_where_they_are_offered(
    camera: Peer, watcher: Watcher
) -> None:
    watcher.observer.watch_pictures([RAW])
    wait_until(lambda: kinds(watcher) == {IMAGE}, "raw pictures, for want of others")
    offer = f"{RAW}/compressed"
    camera.advertise(offer, type_name=COMPRESSED_IMAGE)
    camera.repeat(offer, value=JPEG, hz=20)
    row = watcher.wait_for(RAW, lambda row: row.pictures_from == offer, "comes from the offer")
    assert not row.measured
    wait_until(lambda: COMPRESSED_IMAGE in kinds(watcher), "compressed pictures")
    camera.withdraw(offer)
    watcher.wait_for(RAW, lambda row: row.measured and not row.pictures_from, "is raw again")


def test_the_relay_listens_while_somebody_looks(
    camera: Peer, watcher: Watcher, module_domain: int
) -> None:
    del camera
    relayed = f"{RAW}/_deck/compressed"
    with subprocess.Popen(
        [sys.executable, "-m", "graph.picture_relay", json.dumps([module_domain, "localhost"])],
        cwd=ROOT,
        stdin=subprocess.PIPE,
    ) as relay:
        assert relay.stdin is not None
        try:
            watcher.observer.measure(all_topics=True)
            row: Any = watcher.wait_for(relayed, lambda row: row.publishers == 1, "is offered")
            let_updates_come(watcher, 5)
            assert not row.measured, "a list of topics asks for no pictures"
            watcher.observer.measure(all_topics=False)
            watcher.observer.watch_pictures([RAW])
            wait_until(lambda: COMPRESSED_IMAGE in kinds(watcher), "relayed pictures")
            sample = watcher.samples[RAW][-1]
            assert sample.value["format"] == "rgb8; jpeg compressed bgr8; of 2x2"
            assert sample.value["header"]["frame_id"] == "eye_link"  # type: ignore[index, call-overload]
        finally:
            relay.stdin.close()
        assert relay.wait(20) == 0
    watcher.wait_for(RAW, lambda row: row.measured, "is raw again")
