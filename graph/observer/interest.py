"""What the screens want to see of the graph."""

from __future__ import annotations

from dataclasses import dataclass

from graph.frames.book import FRAME_TOPICS


@dataclass(frozen=True)
class Interest:
    """What a screen wants to see."""

    watched: frozenset[str] = frozenset()
    followed: frozenset[str] = frozenset()
    all_topics: bool = False
    actions: frozenset[str] = frozenset()
    """Actions whose goals are wanted, including other clients' goals."""
    inner_states: bool = False
    """Whether nodes are asked for their lifecycle, and containers for their components."""
    frames: bool = False
    """Whether the frames of /tf and /tf_static are wanted."""
    pictures: frozenset[str] = frozenset()
    """Topics of which the newest picture is wanted, from the topic that carries it cheapest."""
    all_images: bool = True
    """Whether `all_topics` includes those with pictures, as far as they come from this machine."""

    all_fast: bool = True
    """Whether it includes those that cost much to follow: fast ones, and large ones."""

    @property
    def named(self) -> frozenset[str]:
        """Topics that are wanted whether they exist or not."""
        named = self.watched | self.followed
        return named | FRAME_TOPICS if self.frames else named
