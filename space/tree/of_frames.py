"""What is wrong with single frames: silent, refused, contested, of another clock."""

from __future__ import annotations

from typing import TYPE_CHECKING

from space.tree.finding import FrameFinding, FrameTrouble, by_whom, listed
from space.tree.heard import ONCE_S, is_stale
from text.ros_names import TF, TF_STATIC
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence

    from space.tree.heard import HeardFrame

FUTURE_S = 0.1
"""A stamp so far ahead is from another clock: tf2 does not look into the future."""
BEHIND_S = 1.0
"""One so far behind is of another clock, or of a node that cannot keep up."""
OTHER_START_S = 1e9
"""Stamps below are no unix time: simulated time, time since the start, or none at all."""


def findings_of_frames(heard: Sequence[HeardFrame], *, simulated: bool = False) -> Iterator[FrameFinding]:
    """Yield what is wrong with each; what one node does to many frames is said once.

    With `simulated` time, stamps cannot be compared with the clock on the wall.
    """
    yield from _numbers(heard)
    yield from _contested(heard)
    yield from _stale(heard)
    yield from _gone(heard)
    if not simulated:
        yield from _clocks(heard)
    yield from _static_moved(heard)
    yield from _slashed(heard)


def _numbers(heard: Iterable[HeardFrame]) -> Iterator[FrameFinding]:
    for found in _grouped(heard, lambda one: one.fault and (one.publishers, one.certain, one.fault)):
        first = found[0]
        text = say(
            "{frames}: {fault}; refused {faults} of {count}",
            frames=listed(_names(found)),
            fault=first.fault,
            faults=sum(one.faults for one in found),
            count=sum(one.count for one in found),
        )
        advice = say("tf2 drops such a transform as well: fix what {node} fills in", node=by_whom([first]))
        yield FrameFinding(FrameTrouble.NUMBERS, _names(found), text, advice)


def _contested(heard: Iterable[HeardFrame]) -> Iterator[FrameFinding]:
    for found in _grouped(heard, lambda one: one.contested and (one.publishers, one.certain)):
        names, nodes = listed(_names(found)), listed(found[0].publishers)
        text = (
            say("{nodes} publish {frames} by turns, so that it jumps", nodes=nodes, frames=names)
            if found[0].certain and len(found[0].publishers) > 1
            else say("several publishers send {frames} by turns, so that it jumps", frames=names)
        )
        advice = say("leave it to one of {nodes}; many nodes have a parameter like publish_tf: false", nodes=nodes)
        yield FrameFinding(FrameTrouble.CONTESTED, _names(found), text, advice)


def _stale(heard: Iterable[HeardFrame]) -> Iterator[FrameFinding]:
    for found in _grouped(heard, lambda one: is_stale(one) and (one.publishers, one.gone)):
        first = found[0]
        text = say(
            "{frames}: silent for {seconds:.0f} s",
            frames=listed(_names(found)),
            seconds=max(one.age_s for one in found),
        )
        if first.publishers:
            advice = say(
                "see in Logs why {node} publishes it no more; tf2 does not answer for a time that "
                "it has not heard of",
                node=by_whom(found[:1]),
            )
        elif first.gone:
            advice = say("{node}, which published it, has gone: start it again", node=first.gone)
        else:
            advice = say("the node that published it has gone: start it again")
        yield FrameFinding(FrameTrouble.STALE, _names(found), text, advice)


def _gone(heard: Iterable[HeardFrame]) -> Iterator[FrameFinding]:
    # Endpoints become known a little later than their messages.
    gone = [one for one in heard if one.is_static and not one.publishers and one.age_s > ONCE_S]
    for found in _grouped(gone, lambda one: (one.gone,)):
        frames, node = listed(_names(found)), found[0].gone
        text = (
            say(
                "{frames}: {node}, which published it on {topic}, has gone", frames=frames, node=node, topic=TF_STATIC
            )
            if node
            else say("{frames}: the node that published it on {topic} has gone", frames=frames, topic=TF_STATIC)
        )
        advice = say("start it again: a node that starts now does not get this frame")
        yield FrameFinding(FrameTrouble.GONE, _names(found), text, advice)


def _clocks(heard: Iterable[HeardFrame]) -> Iterator[FrameFinding]:
    moving = [one for one in heard if not one.is_static and one.count > one.faults]
    for found in _grouped(moving, lambda one: (kind := _clock(one)) and (kind, one.publishers, one.certain)):
        first = found[0]
        values: dict[str, object] = {
            "frames": listed(_names(found)),
            "node": by_whom([first]),
            "seconds": abs(first.delay_s),
            "stamp": first.newest.stamp_s,
        }
        text, advice = _CLOCK_WORDS[_clock(first)](values)
        yield FrameFinding(FrameTrouble.CLOCK, _names(found), text, advice)


def _clock(one: HeardFrame) -> str:
    """Return what is wrong with its stamps, empty if nothing is."""
    if one.newest.stamp_s < OTHER_START_S:
        return "other start" if one.delay_s > BEHIND_S else ""
    if one.delay_s < -FUTURE_S:
        return "future"
    return "behind" if one.delay_s > BEHIND_S else ""


def _of_other_start(values: dict[str, object]) -> tuple[str, str]:
    return (
        say("{frames}: stamped {stamp:.1f} s, which cannot be the present time", **values),
        say(
            "have {node} stamp with its clock, node.get_clock().now(); in simulated time set "
            "use_sim_time for all nodes or for none",
            **values,
        ),
    )


def _of_future(values: dict[str, object]) -> tuple[str, str]:
    return (
        say("{frames}: stamped {seconds:.1f} s in the future", **values),
        say(
            "set the clocks of both machines by the same server (chrony); {node} must not add time to its stamps",
            **values,
        ),
    )


def _of_past(values: dict[str, object]) -> tuple[str, str]:
    return (
        say("{frames}: stamped {seconds:.1f} s before it arrives", **values),
        say(
            "set the clocks of both machines by the same server (chrony), or find out what holds {node} up", **values
        ),
    )


_CLOCK_WORDS = {"other start": _of_other_start, "future": _of_future, "behind": _of_past}


def _static_moved(heard: Iterable[HeardFrame]) -> Iterator[FrameFinding]:
    for found in _grouped(heard, lambda one: one.moved and (one.publishers, one.certain)):
        first = found[0]
        words: dict[str, object] = {
            "frames": listed(_names(found)),
            "nodes": listed(first.publishers),
            "topic": TF_STATIC,
        }
        if first.certain and len(first.publishers) > 1:
            text = say("{nodes} publish {frames} on {topic} with different numbers", **words)
            advice = say("leave it to one: which of them holds depends on who comes last")
        else:
            text = say("{frames}: comes on {topic} with different numbers", **words)
            advice = say(
                "what moves belongs on {topic}; if two nodes publish it, leave it to one: {nodes}",
                topic=TF,
                nodes=words["nodes"],
            )
        yield FrameFinding(FrameTrouble.STATIC_MOVED, _names(found), text, advice)


def _slashed(heard: Iterable[HeardFrame]) -> Iterator[FrameFinding]:
    for found in _grouped(heard, lambda one: one.slashed and (one.publishers, one.certain)):
        text = say("{frames}: published with a slash in front", frames=listed(_names(found)))
        advice = say(
            "take it away in {node}: tf2 knows names without one, and others may look for it with the slash",
            node=by_whom(found[:1]),
        )
        yield FrameFinding(FrameTrouble.SLASH, _names(found), text, advice)


def _grouped(heard: Iterable[HeardFrame], key: Callable[[HeardFrame], Hashable]) -> list[list[HeardFrame]]:
    """Return those that have a key, together with others of the same."""
    found: dict[Hashable, list[HeardFrame]] = {}
    for one in heard:
        if of := key(one):
            found.setdefault(of, []).append(one)
    return list(found.values())


def _names(found: Iterable[HeardFrame]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(one.newest.child for one in found))
