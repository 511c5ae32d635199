"""Who is there and who talks to whom: nodes, services, actions, and the QoS of every endpoint."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from graph.data import ActionRow, EndpointInfo, ServiceRow
from graph.housekeeping import is_housekeeping
from tests.ros.observing import Peer, Watcher
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

FLOAT = "std_msgs/msg/Float32"
DRIVE = "deck_interfaces/action/DriveToPoint"
ADD = "example_interfaces/srv/AddTwoInts"


@pytest.fixture
def peers(ros_domain: int) -> Iterator[list[Peer]]:
    peers = [Peer("driver", ros_domain), Peer("person", ros_domain)]
    yield peers
    for peer in peers:
        peer.close()


def the_end(watcher: Watcher, topic: str, side: str) -> EndpointInfo:
    """The only publisher or subscription of a topic."""
    row = watcher.wait_for(topic, lambda row: len(getattr(row, side)) == 1, side)
    (end,) = getattr(row, side)
    assert isinstance(end, EndpointInfo)
    return end


def test_every_policy_of_an_endpoint_is_told(watcher: Watcher, peers: list[Peer]) -> None:
    peers[0].advertise(
        "/a",
        type_name=FLOAT,
        reliability="best_effort",
        durability="transient_local",
        liveliness="manual_by_topic",
        deadline=0.5,
        lifespan=2.0,
        liveliness_lease_duration=3.0,
    )
    peers[1].listen("/b", type_name=FLOAT, deadline=1.5)
    told = the_end(watcher, "/a", "published_by")
    assert (told.node, told.type_name) == ("/driver", FLOAT)
    assert (told.reliability, told.durability) == ("best_effort", "transient_local")
    assert told.deadline_s == pytest.approx(0.5)
    assert told.lifespan_s == pytest.approx(2.0)
    assert told.lease_s == pytest.approx(3.0)
    assert told.liveliness == "manual_by_topic"
    # Fast DDS announces neither.
    assert (told.history, told.depth) == ("", 0)
    told = the_end(watcher, "/b", "subscribed_by")
    assert told.deadline_s == pytest.approx(1.5)
    assert (told.lifespan_s, told.lease_s, told.liveliness) == (None, None, "automatic")


def test_services_name_those_who_serve_and_those_who_call(
    watcher: Watcher, peers: list[Peer]
) -> None:
    peers[0].serve("/add")
    peers[1].use("/add")
    peers[1].use("/nobody_serves_it")
    wait_until(lambda: (row := watcher.node("/person")) and len(row.clients) == 2, "both clients")
    person, driver = watcher.node("/person"), watcher.node("/driver")
    assert person is not None
    assert driver is not None
    assert person.clients == ("/add", "/nobody_serves_it")
    assert (driver.services.count("/add"), driver.clients) == (1, ())
    added = [row for row in watcher.update.services if not is_housekeeping(row.name)]
    assert added == [ServiceRow("/add", (ADD,), ("/driver",))]
    peers[1].stop_using("/add")
    wait_until(
        lambda: (row := watcher.node("/person")) and row.clients == ("/nobody_serves_it",),
        "one client left",
    )


def test_an_action_is_one_thing_and_not_three_services(watcher: Watcher, peers: list[Peer]) -> None:
    peers[0].serve_drive("/drive_to_point")
    peers[1].use_drive("/drive_to_point")
    expected = ActionRow("/drive_to_point", (DRIVE,), ("/driver",), ("/person",))
    wait_until(lambda: watcher.update.actions == (expected,), "the action with both its sides")
    person, driver = watcher.node("/person"), watcher.node("/driver")
    assert person is not None
    assert driver is not None
    assert (driver.action_servers, driver.action_clients) == (("/drive_to_point",), ())
    assert (person.action_servers, person.action_clients) == ((), ("/drive_to_point",))
    names = [*driver.services, *person.clients, *(row.name for row in watcher.update.services)]
    assert not [name for name in names if "_action" in name]
    inner = [row.name for row in watcher.update.topics if "_action" in row.name]
    assert inner
    assert all(is_housekeeping(name) for name in inner)
    peers.pop(0).close()
    left = ActionRow("/drive_to_point", (DRIVE,), (), ("/person",))
    wait_until(lambda: watcher.update.actions == (left,), "nobody serves it any more")
