"""What is wrong with the tree: loops, frames with two parents, parts that nothing joins."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from space.tree.finding import FrameFinding, FrameTrouble, by_whom, listed
from text.ros_names import TF, TF_STATIC
from text.sentences import say
from text.suggestions import near

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from space.tree.tree import FrameTree

ALIKE = 0.85
"""Names that are as similar as this may be a slip of the pen."""
MOST_COMPARED = 20
"""Roots and names whose slips are looked for: comparing all with all takes long."""


def findings_of_tree(tree: FrameTree, named: Mapping[str, str], *, settling: bool = False) -> Iterator[FrameFinding]:
    """Yield what is wrong; `named` is topic to the frame that the header of its messages names.

    While it is `settling`, nothing is said to be missing.
    """
    yield from _loops(tree)
    yield from _parents(tree)
    yield from _both(tree)
    if not settling:
        yield from _roots(tree)
        yield from _unknown(tree, named)


def _loops(tree: FrameTree) -> Iterator[FrameFinding]:
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
        yield FrameFinding(FrameTrouble.LOOP, loop, text, advice)


def _parents(tree: FrameTree) -> Iterator[FrameFinding]:
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
        yield FrameFinding(FrameTrouble.PARENTS, (frame, *parents), text, advice)


def _roots(tree: FrameTree) -> Iterator[FrameFinding]:
    if len(tree.parts) < 2:
        return
    text = say(
        "{count} trees that nothing joins, with the roots {roots}", count=len(tree.parts), roots=listed(tree.parts)
    )
    main, *others = tree.parts
    yield FrameFinding(FrameTrouble.ROOTS, tree.parts, text, _to_join(tree, main, others))


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


def _unknown(tree: FrameTree, named: Mapping[str, str]) -> Iterator[FrameFinding]:
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
        yield FrameFinding(FrameTrouble.UNKNOWN, (frame,), text, advice)


def _both(tree: FrameTree) -> Iterator[FrameFinding]:
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
        yield FrameFinding(FrameTrouble.BOTH, (child, parent), text, advice)


@lru_cache(maxsize=4 * MOST_COMPARED)
def _meant(name: str, known: frozenset[str]) -> str:
    """Return the frame that was probably meant, empty if none is as similar."""
    return next(iter(near(name, sorted(known), cutoff=ALIKE)), "")
