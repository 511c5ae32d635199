"""Frames of real publishers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from graph.data import FrameRow
from graph.frames.book import TF_MESSAGE
from tests.ros.observing import Peer, Watcher
from tests.unit.transform_messages import Sent
from tests.waiting import wait_until


def value(*sent: Sent) -> dict[str, Any]:
    return {
        "transforms": [
            {
                "header": {"stamp": {"sec": int(one.stamp_s), "nanosec": 0}, "frame_id": one.parent},
                "child_frame_id": one.child,
                "transform": {
                    "translation": dict(zip("xyz", one.translation, strict=True)),
                    "rotation": dict(zip("xyzw", one.rotation, strict=True)),
                },
            }
            for one in sent
        ]
    }


def frames(watcher: Watcher, child: str) -> list[FrameRow]:
    return [row for row in watcher.update.frames if row.newest.child == child]


def see(watcher: Watcher, child: str, test: Any, what: str) -> FrameRow:
    """Wait for a row of this frame that passes."""
    return wait_until(lambda: next((row for row in frames(watcher, child) if test(row)), None), f"{child}: {what}")


def repeat(peer: Peer, hz: float, *sent: Sent) -> None:
    peer.advertise("/tf", type_name=TF_MESSAGE)
    peer.repeat("/tf", value=value(*sent), hz=hz)


def latch(peer: Peer, *sent: Sent) -> None:
    peer.advertise("/tf_static", type_name=TF_MESSAGE, durability="transient_local", depth=1)
    peer.publish("/tf_static", value=value(*sent))


pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module")
def peers(module_domain: int) -> Iterator[tuple[Peer, Peer]]:
    made = Peer("driver", module_domain), Peer("arm", module_domain)
    yield made
    for peer in made:
        peer.close()


@pytest.fixture
def watcher(module_watcher: Watcher) -> Iterator[Watcher]:
    module_watcher.want(frames=True)
    yield module_watcher
    module_watcher.want(frames=False)
    module_watcher.want(all_topics=False)
    wait_until(lambda: not module_watcher.update.frames, "no frames any more")


def test_two_publishers_on_both_topics_are_told_apart(peers: tuple[Peer, Peer], watcher: Watcher) -> None:
    driver, arm = peers
    repeat(driver, 50, Sent("odom", "base_link", 5.0, (1.0, 2.0, 0.0)))
    latch(arm, Sent("base_link", "camera_link", 0.0, (0.15, 0.0, 0.25)))
    moving = see(
        watcher,
        "base_link",
        # After a pause of the machine several come at once.
        lambda row: row.hz == pytest.approx(50, rel=0.2) and row.publishers == (driver.name,),
        "is known with its rate",
    )
    assert moving.newest.transform.translation == (1.0, 2.0, 0.0)
    # Its stamp is of 1970.
    assert moving.delay_s > 1e9
    camera = see(watcher, "camera_link", lambda row: row.publishers == (arm.name,), "is known")
    assert camera.is_static
    assert camera.newest.transform.translation == (0.15, 0.0, 0.25)
    driver.withdraw("/tf")
    arm.withdraw("/tf_static")
