"""All that is wrong with the frames, the worst first, in words with what to do."""

from __future__ import annotations

from collections import Counter
from functools import lru_cache
from typing import TYPE_CHECKING

from graph.findings.finding import FindingLevel, FindingPlace, GraphFinding
from graph.frames.book import FRAME_TOPICS, MOST_FRAMES, TF_MESSAGE
from graph.qos import VOLATILE
from text.ros_names import TF, TF_STATIC
from text.sentences import say
from text.suggestions import near

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence

    from graph.data import FrameRow, GraphUpdate
    from graph.frames.tree import FrameTree

NAMED = 3
"""Frames and nodes that a sentence names; the others are counted."""


ORDER = (
    *("full", "loop", "two parents", "contested", "numbers", "stale", "gone", "two roots", "unknown frame"),
    *("clock", "both topics", "static moved", "volatile", "elsewhere", "slash"),
)
"""The rules, from what stops tf2 to what will puzzle somebody later."""


def _found(rule: str, frames: tuple[str, ...], what: str, mend: str) -> GraphFinding:
    """Return what is wrong with these frames, and what to do, both sentences."""
    return GraphFinding(
        FindingLevel.ERROR, rule, FindingPlace("frame", frames[0] if frames else ""), what, mend, frames
    )


def listed(names: Sequence[str]) -> str:
    """Name the first of them, and count the others; what is there several times is named once."""
    if not names:
        return say("nobody")
    counted = Counter(names)
    first, *others = list(counted)[:NAMED]
    words = _called(first, counted[first])
    for name in others:
        # Nested, since a name may be a sentence that is still to be translated.
        words = say("{names}, {name}", names=words, name=_called(name, counted[name]))
    more = len(counted) - NAMED
    return say("{names} and {count} more", names=words, count=more) if more > 0 else words


def by_whom(heard: Sequence[FrameRow]) -> str:
    """Name the publishers of frames, or those that it may be."""
    names: Counter[str] = Counter()
    for one in heard:
        names |= Counter(one.publishers)
    nodes = listed(tuple(names.elements()))
    return nodes if all(one.certain for one in heard) else say("one of {nodes}", nodes=nodes)


def _called(name: str, times: int) -> str:
    called = name or say("a frame without a name")
    return say("{name} ({count} of this name)", name=called, count=times) if times > 1 else called


STALE_PERIODS, STALE_S = 5.0, 1.0
"""A moving frame is stale after so many of its periods, and never sooner than that."""
ONCE_S = 3.0
"""One that has come only once is stale after this long."""


def is_stale(heard: FrameRow) -> bool:
    """Return whether a moving frame has been silent for longer than a few of its periods."""
    if heard.is_static:
        return False
    if heard.hz is None:
        return heard.age_s > ONCE_S
    return heard.age_s > max(STALE_S, STALE_PERIODS / max(heard.hz, 1e-3))


CLOCK = "/clock"


def findings_in(update: GraphUpdate, tree: FrameTree) -> list[GraphFinding]:
    """Return what is wrong with the frames of an update, which this tree was made of, the worst first."""
    named = {row.name: row.frame_id for row in update.topics if row.frame_id}
    # In simulated time stamps are no times of day.
    simulated = any(row.name == CLOCK and row.publishers for row in update.topics)
    found = [
        *findings_of_tree(tree, named, settling=is_settling(update)),
        *findings_of_frames(update.frames, simulated=simulated),
        *_full(update),
        *_volatile(update),
        *_elsewhere(update),
    ]
    return sorted(found, key=lambda one: ORDER.index(one.rule))


def _full(update: GraphUpdate) -> Iterator[GraphFinding]:
    if len(update.frames) >= MOST_FRAMES:
        text = say("there are more than {most} frames; the others are not shown", most=MOST_FRAMES)
        advice = say("look for a node that makes a new name each time, such as one with a number or a time in it")
        yield _found("full", (), text, advice)


def _volatile(update: GraphUpdate) -> Iterator[GraphFinding]:
    ends = [end for row in update.topics if row.name == TF_STATIC for end in row.published_by]
    volatile = tuple(dict.fromkeys(end.called for end in ends if end.durability == VOLATILE))
    if volatile:
        text = say(
            "{nodes}: publishes {topic} without transient_local, so that tf2 does not hear it",
            nodes=listed(volatile),
            topic=TF_STATIC,
        )
        advice = say(
            "create its publisher with durability transient_local and depth 1, as "
            "tf2_ros.StaticTransformBroadcaster does"
        )
        yield _found("volatile", (), text, advice)


def _elsewhere(update: GraphUpdate) -> Iterator[GraphFinding]:
    for row in update.topics:
        if TF_MESSAGE not in row.type_names or row.name in FRAME_TOPICS or not row.publishers:
            continue
        text = (
            say("frames come on {topic} too, where tf2 does not listen by itself", topic=row.name)
            if row.subscribers
            else say("frames come on {topic} too, which nobody here listens to", topic=row.name)
        )
        advice = say(
            "start its publisher with -r {topic}:={usual}, or whoever needs these frames with -r {usual}:={topic}",
            topic=row.name,
            usual=TF_STATIC if row.name.endswith(TF_STATIC) else TF,
        )
        yield _found("elsewhere", (), text, advice)


def is_settling(update: GraphUpdate) -> bool:
    """Return whether somebody publishes /tf_static, and its frames are still to come.

    What has come before comes again, because it is latched; what has not is not waited for long.
    """
    return not any(row.is_static for row in update.frames) and any(
        row.name == TF_STATIC and row.publishers and (row.count or row.trouble is None) for row in update.topics
    )


# ---------------------------------------------------------------- single frames

FUTURE_S = 0.1
"""A stamp so far ahead is from another clock: tf2 does not look into the future."""
BEHIND_S = 1.0
"""One so far behind is of another clock, or of a node that cannot keep up."""
OTHER_START_S = 1e9
"""Stamps below are no unix time: simulated time, time since the start, or none at all."""


def findings_of_frames(heard: Sequence[FrameRow], *, simulated: bool = False) -> Iterator[GraphFinding]:
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


def _numbers(heard: Iterable[FrameRow]) -> Iterator[GraphFinding]:
    for found in _together(heard, lambda one: one.fault and (one.publishers, one.certain, one.fault)):
        first = found[0]
        text = say(
            "{frames}: {fault}; refused {faults} of {count}",
            frames=listed(_names(found)),
            fault=first.fault,
            faults=sum(one.faults for one in found),
            count=sum(one.count for one in found),
        )
        advice = say("tf2 drops such a transform as well: fix what {node} fills in", node=by_whom([first]))
        yield _found("numbers", _names(found), text, advice)


def _contested(heard: Iterable[FrameRow]) -> Iterator[GraphFinding]:
    for found in _together(heard, lambda one: one.contested and (one.publishers, one.certain)):
        names, nodes = listed(_names(found)), listed(found[0].publishers)
        text = (
            say("{nodes} publish {frames} by turns, so that it jumps", nodes=nodes, frames=names)
            if found[0].certain and len(found[0].publishers) > 1
            else say("several publishers send {frames} by turns, so that it jumps", frames=names)
        )
        advice = say("leave it to one of {nodes}; many nodes have a parameter like publish_tf: false", nodes=nodes)
        yield _found("contested", _names(found), text, advice)


def _stale(heard: Iterable[FrameRow]) -> Iterator[GraphFinding]:
    for found in _together(heard, lambda one: is_stale(one) and (one.publishers, one.gone)):
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
        yield _found("stale", _names(found), text, advice)


def _gone(heard: Iterable[FrameRow]) -> Iterator[GraphFinding]:
    # Endpoints become known a little later than their messages.
    gone = [one for one in heard if one.is_static and not one.publishers and one.age_s > ONCE_S]
    for found in _together(gone, lambda one: (one.gone,)):
        frames, node = listed(_names(found)), found[0].gone
        text = (
            say(
                "{frames}: {node}, which published it on {topic}, has gone", frames=frames, node=node, topic=TF_STATIC
            )
            if node
            else say("{frames}: the node that published it on {topic} has gone", frames=frames, topic=TF_STATIC)
        )
        advice = say("start it again: a node that starts now does not get this frame")
        yield _found("gone", _names(found), text, advice)


def _clocks(heard: Iterable[FrameRow]) -> Iterator[GraphFinding]:
    moving = [one for one in heard if not one.is_static and one.count > one.faults]
    for found in _together(moving, lambda one: (kind := _clock(one)) and (kind, one.publishers, one.certain)):
        first, kind = found[0], _clock(found[0])
        frames, node, seconds = listed(_names(found)), by_whom(found[:1]), abs(first.delay_s)
        if kind == "other start":
            stamp = first.newest.stamp_s
            text = say(
                "{frames}: stamped {stamp:.1f} s, which cannot be the present time", frames=frames, stamp=stamp
            )
            advice = say(
                "have {node} stamp with its clock, node.get_clock().now(); in simulated time set "
                "use_sim_time for all nodes or for none",
                node=node,
            )
        elif kind == "future":
            text = say("{frames}: stamped {seconds:.1f} s in the future", frames=frames, seconds=seconds)
            advice = say(
                "set the clocks of both machines by the same server (chrony); {node} must not add time to its stamps",
                node=node,
            )
        else:
            text = say("{frames}: stamped {seconds:.1f} s before it arrives", frames=frames, seconds=seconds)
            advice = say(
                "set the clocks of both machines by the same server (chrony), or find out what holds {node} up",
                node=node,
            )
        yield _found("clock", _names(found), text, advice)


def _clock(one: FrameRow) -> str:
    """Return what is wrong with its stamps, empty if nothing is."""
    if one.newest.stamp_s < OTHER_START_S:
        return "other start" if one.delay_s > BEHIND_S else ""
    if one.delay_s < -FUTURE_S:
        return "future"
    return "behind" if one.delay_s > BEHIND_S else ""


def _static_moved(heard: Iterable[FrameRow]) -> Iterator[GraphFinding]:
    for found in _together(heard, lambda one: one.moved and (one.publishers, one.certain)):
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
        yield _found("static moved", _names(found), text, advice)


def _slashed(heard: Iterable[FrameRow]) -> Iterator[GraphFinding]:
    for found in _together(heard, lambda one: one.slashed and (one.publishers, one.certain)):
        text = say("{frames}: published with a slash in front", frames=listed(_names(found)))
        advice = say(
            "take it away in {node}: tf2 knows names without one, and others may look for it with the slash",
            node=by_whom(found[:1]),
        )
        yield _found("slash", _names(found), text, advice)


def _together(heard: Iterable[FrameRow], key: Callable[[FrameRow], Hashable]) -> list[list[FrameRow]]:
    """Return those that have a key, together with others of the same."""
    found: dict[Hashable, list[FrameRow]] = {}
    for one in heard:
        if of := key(one):
            found.setdefault(of, []).append(one)
    return list(found.values())


def _names(found: Iterable[FrameRow]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(one.newest.child for one in found))


# ---------------------------------------------------------------- the tree

ALIKE = 0.85
"""Names that are as similar as this may be a slip of the pen."""
MOST_COMPARED = 20
"""Roots and names whose slips are looked for: comparing all with all takes long."""


def findings_of_tree(tree: FrameTree, named: Mapping[str, str], *, settling: bool = False) -> Iterator[GraphFinding]:
    """Yield what is wrong; `named` is topic to the frame that the header of its messages names.

    While it is `settling`, nothing is said to be missing.
    """
    yield from _loops(tree)
    yield from _parents(tree)
    yield from _both(tree)
    if not settling:
        yield from _roots(tree)
        yield from _unknown(tree, named)


def _loops(tree: FrameTree) -> Iterator[GraphFinding]:
    for loop in tree.loops:
        text = say(
            "{frames} and back to {first}: a loop, which has no root", frames=" → ".join(loop[:8]), first=loop[0]
        )
        closing = tree.edges[loop[-1], loop[0]]
        advice = say(
            "a frame's parent is the one that it hangs on: take {parent} → {child} out of {node}",
            parent=loop[-1],
            child=loop[0],
            node=by_whom(closing),
        )
        yield _found("loop", loop, text, advice)


def _parents(tree: FrameTree) -> Iterator[GraphFinding]:
    for frame, parents in sorted(tree.parents.items()):
        if len(parents) < 2:
            continue
        first, second = parents[:2]
        text = say(
            "{frame} has two parents: {first} by {one}, {second} by {other}",
            frame=frame,
            first=first,
            one=by_whom(tree.edges[first, frame]),
            second=second,
            other=by_whom(tree.edges[second, frame]),
        )
        advice = say(
            "it would jump between the two: keep one, and turn the other round ({frame} → {first}) "
            "or give it another name",
            frame=frame,
            first=first,
        )
        yield _found("two parents", (frame, *parents), text, advice)


def _roots(tree: FrameTree) -> Iterator[GraphFinding]:
    if len(tree.parts) < 2:
        return
    text = say(
        "{count} trees that nothing joins, with the roots {roots}", count=len(tree.parts), roots=listed(tree.parts)
    )
    main, *others = tree.parts
    yield _found("two roots", tree.parts, text, _to_join(tree, main, others))


def _to_join(tree: FrameTree, main: str, others: list[str]) -> str:
    for root in others[:MOST_COMPARED]:
        meant = _meant(root, tree.frames - {root, *tree.children[root]})
        if meant:
            return say(
                "is {root} a slip for {meant}? Then correct the parent that {node} gives",
                root=root,
                meant=meant,
                node=by_whom(tree.edges[root, tree.children[root][0]]),
            )
    return say(
        "publish where {root} is in the other tree: ros2 run tf2_ros static_transform_publisher "
        "--frame-id {main} --child-frame-id {root}",
        # What is the root of a loop has a parent already.
        root=min(others, key=lambda root: root in tree.parents),
        main=main,
    )


def _unknown(tree: FrameTree, named: Mapping[str, str]) -> Iterator[GraphFinding]:
    unknown: dict[str, list[str]] = {}
    for topic, frame in sorted(named.items()):
        bare = frame.removeprefix("/")
        if bare and tree.frames and bare not in tree.frames:
            unknown.setdefault(bare, []).append(topic)
    for number, (frame, topics) in enumerate(unknown.items()):
        text = say("{topics}: the header names {frame}, which no tree knows", topics=listed(topics), frame=frame)
        meant = _meant(frame, tree.frames) if number < MOST_COMPARED else ""
        if meant:
            advice = say("is it a slip for {meant}?", meant=meant)
        else:
            advice = say(
                "publish where it is: ros2 run tf2_ros static_transform_publisher "
                "--frame-id {root} --child-frame-id {frame}",
                root=tree.roots[0],
                frame=frame,
            )
        yield _found("unknown frame", (frame,), text, advice)


def _both(tree: FrameTree) -> Iterator[GraphFinding]:
    for (parent, child), heard in tree.edges.items():
        if len(heard) < 2:
            continue
        moving, static = sorted(heard, key=lambda one: one.is_static)[:2]
        text = say(
            "{child} in {parent} comes on {moving} by {one} and on {static} by {other}",
            child=child,
            parent=parent,
            moving=TF,
            one=by_whom([moving]),
            static=TF_STATIC,
            other=by_whom([static]),
        )
        advice = say(
            "what moves is published on {moving} alone, what is fixed on {static} alone, once",
            moving=TF,
            static=TF_STATIC,
        )
        yield _found("both topics", (child, parent), text, advice)


@lru_cache(maxsize=4 * MOST_COMPARED)
def _meant(name: str, known: frozenset[str]) -> str:
    """Return the frame that was probably meant, empty if none is as similar."""
    return next(iter(near(name, sorted(known), cutoff=ALIKE)), "")
