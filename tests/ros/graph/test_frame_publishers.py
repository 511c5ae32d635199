"""Which node sent a frame, by what the middleware tells of each message, among real processes."""

from __future__ import annotations

import ctypes
import ctypes.util
import types
from collections.abc import Iterator
from contextlib import closing

import pytest
from rclpy.impl.implementation_singleton import rclpy_implementation

from graph.data import FrameRow
from graph.frames.senders import TOGETHER_S
from graph.observer.taking import SenderReader
from space.tree.finding import FrameTrouble
from space.tree.findings import Surroundings, frame_findings
from space.tree.tree import FrameTree
from tests.ros.frame_publishing import frames, latch, repeat, see
from tests.ros.observing import Peer, Watcher
from tests.unit.transform_messages import Sent
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

LIBRARY = rclpy_implementation.__file__
FUNCTIONS = (
    "rcl_take_serialized_message",
    "rcutils_get_default_allocator",
    "rcutils_reset_error",
    "rcutils_uint8_array_fini",
    "rmw_get_implementation_identifier",
)


@pytest.fixture(scope="module")
def peers(module_domain: int) -> Iterator[tuple[Peer, Peer, Peer]]:
    made = tuple(Peer(name, module_domain) for name in ("driver", "arm", "head"))
    yield made[0], made[1], made[2]
    for peer in made:
        peer.close()


@pytest.fixture(scope="module")
def module_watcher(module_domain: int, peers: tuple[Peer, Peer, Peer]) -> Iterator[Watcher]:
    """It comes after frames of each peer, one of them latched."""
    for peer in peers:
        name = peer.name.removeprefix("/")
        repeat(peer, 20, Sent("odom", f"moved_by_{name}"))
        latch(peer, Sent("odom", f"fixed_by_{name}"))
    made = Watcher(module_domain)
    yield made
    made.close()


@pytest.fixture
def watcher(module_watcher: Watcher) -> Iterator[Watcher]:
    """It begins to listen."""
    module_watcher.observer.watch_frames(True)
    yield module_watcher
    module_watcher.observer.watch_frames(False)
    wait_until(lambda: not module_watcher.update.frames, "no frames any more")


def published(peer: Peer) -> tuple[tuple[str, ...], bool]:
    """What is to be said of a frame of this peer alone."""
    return (peer.name,), True


def who(row: FrameRow) -> tuple[tuple[str, ...], bool]:
    return row.publishers, row.certain


def findings(watcher: Watcher, trouble: FrameTrouble) -> list[str]:
    rows = watcher.update.frames
    found = frame_findings(FrameTree(rows), rows, Surroundings())
    return [f"{one.text}; {one.advice}" for one in found if one.trouble is trouble]


def test_each_frame_has_its_own_node_also_if_it_was_latched_before_deck_came(
    peers: tuple[Peer, Peer, Peer], watcher: Watcher
) -> None:
    for peer in peers:
        for kind in ("moved", "fixed"):
            child = f"{kind}_by_{peer.name.removeprefix('/')}"
            see(watcher, child, lambda row, peer=peer: who(row) == published(peer), "is known")


def test_a_frame_with_two_parents_names_both_who_give_it_one(
    peers: tuple[Peer, Peer, Peer], watcher: Watcher
) -> None:
    for peer, parent in zip(peers[1:], ("map", "world"), strict=True):
        latch(peer, Sent(parent, "torn"))
    wait_until(
        lambda: {who(row) for row in frames(watcher, "torn")} == {*map(published, peers[1:])},
        "both are known",
    )
    (said,) = findings(watcher, FrameTrouble.PARENTS)
    assert "torn has two parents: map by /arm, world by /head" in said


def test_two_nodes_that_send_one_frame_are_both_named_and_no_third(
    peers: tuple[Peer, Peer, Peer], watcher: Watcher
) -> None:
    for peer in peers[:2]:
        repeat(peer, 20, Sent("odom", "shared"))
    both = (("/arm", "/driver"), True)
    see(watcher, "shared", lambda row: row.contested and who(row) == both, "is contested")
    (said,) = findings(watcher, FrameTrouble.CONTESTED)
    assert "/arm, /driver publish shared by turns" in said
    for peer in peers[:2]:
        repeat(peer, 20, Sent("odom", f"moved_by_{peer.name.removeprefix('/')}"))


def test_two_latched_publishers_of_one_frame_are_noticed_however_far_apart(
    peers: tuple[Peer, Peer, Peer], watcher: Watcher
) -> None:
    latch(peers[0], Sent("base", "lens", translation=(0.1, 0.0, 0.0)))
    # Two that come at once could be told from a restart without knowing who has sent them.
    row = see(watcher, "lens", lambda row: row.age_s > 2 * TOGETHER_S, "is old")
    assert (who(row), row.moved) == (published(peers[0]), False)
    latch(peers[1], Sent("base", "lens", translation=(0.2, 0.0, 0.0)))
    see(watcher, "lens", lambda row: row.moved, "is of two")
    (said,) = findings(watcher, FrameTrouble.STATIC_MOVED)
    assert "/arm, /driver publish lens on /tf_static with different numbers" in said
    peers[1].withdraw("/tf_static")
    row = see(watcher, "lens", lambda row: not row.moved, "is of one again")
    assert who(row) == published(peers[0])


def test_a_node_that_is_killed_and_comes_back_under_its_name_is_one_node(
    module_domain: int, watcher: Watcher
) -> None:
    for turn in range(2):
        with closing(Peer("gripper", module_domain)) as peer:
            latch(peer, Sent("base", "finger", translation=(float(turn), 0.0, 0.0)))
            repeat(peer, 20, Sent("finger", "tip"))
            for child in ("finger", "tip"):
                row = see(
                    watcher,
                    child,
                    lambda row, turn=turn: row.count > turn and who(row) == (("/gripper",), True),
                    "is known",
                )
                assert not row.moved
                assert not row.contested
            if turn == 0:
                peer.kill()
    # This one has taken its leave.
    row = see(watcher, "finger", lambda row: not row.publishers, "has nobody")
    assert row.gone == "/gripper"


def test_a_publisher_that_a_node_makes_anew_is_known_too(
    peers: tuple[Peer, Peer, Peer], watcher: Watcher
) -> None:
    head = peers[2]
    see(watcher, "fixed_by_head", lambda row: who(row) == published(head), "is known")
    # Too fast for anybody to see that there was none in between.
    head.withdraw("/tf_static")
    latch(head, Sent("base", "eye"))
    see(watcher, "eye", lambda row: who(row) == published(head), "is known")


def test_two_nodes_of_one_name_are_told_apart(module_domain: int, watcher: Watcher) -> None:
    with closing(Peer("twin", module_domain)) as one, closing(Peer("twin", module_domain)) as other:
        for peer in (one, other):
            repeat(peer, 20, Sent("odom", "shadow"))
        both = (("/twin", "/twin"), True)
        see(watcher, "shadow", lambda row: row.contested and who(row) == both, "is contested")


def _none() -> None:
    return None


def _of_another_layout() -> SenderReader:
    reader = SenderReader(ctypes.PyDLL(LIBRARY))
    reader._middleware = 1
    return reader


def _that_fails() -> SenderReader:
    reader = SenderReader(ctypes.PyDLL(LIBRARY))
    reader._take = lambda *_: 1
    return reader


@pytest.fixture(params=[_none, _of_another_layout, _that_fails])
def hindered(
    request: pytest.FixtureRequest, module_watcher: Watcher, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Watcher]:
    """It begins to listen, and what it would call in rcl is not as it should be."""
    monkeypatch.setattr(SenderReader, "load", request.param)
    module_watcher.observer.watch_frames(True)
    yield module_watcher
    module_watcher.observer.watch_frames(False)
    wait_until(lambda: not module_watcher.update.frames, "no frames any more")


def test_without_what_is_called_in_rcl_frames_come_with_those_who_may_be(
    peers: tuple[Peer, Peer, Peer], hindered: Watcher
) -> None:
    everyone = {peer.name for peer in peers}
    # Beside them may be those that were killed a moment ago.
    row = see(
        hindered,
        "moved_by_arm",
        lambda row: row.count > 3 and everyone <= set(row.publishers),
        "may be of each",
    )
    assert not row.certain


@pytest.mark.parametrize(
    "library",
    [ctypes.PyDLL(None), ctypes.PyDLL(ctypes.util.find_library("c"))],
    ids=["the program", "another"],
)
def test_a_library_without_rcl_is_refused(library: ctypes.CDLL) -> None:
    with pytest.raises(AttributeError):
        SenderReader(library)


def test_a_library_that_fills_in_something_else_is_refused() -> None:
    real = ctypes.PyDLL(LIBRARY)
    other = types.SimpleNamespace(
        **{name: getattr(real, name) for name in FUNCTIONS},
        rcutils_uint8_array_init=real.rcutils_reset_error,
    )
    with pytest.raises(ValueError, match="another layout"):
        SenderReader(other)  # type: ignore[arg-type]
