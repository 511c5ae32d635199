"""What the robot that comes with Deck says of itself, to the rooms that would serve any other as well.

They ask `robot()`. Without the room `robot` all of it is empty: what is left is what ROS says.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from importlib import import_module
from typing import Literal, NamedTuple

Role = Literal["drives", "gate", "wheels", "brain", "words", "head", "driver", "simulator"]
"""What a node is for the robot, whatever it is called:

`drives`: it commands the wheels, so that two of them never share a domain; `gate`: every command passes it; `wheels`:
it turns what the gate lets pass into what each wheel does; `brain`: it decides what is done; `words`: it obeys words;
`head`: it turns the head; `driver`: it reports on /diagnostics what is at its port; `simulator`: its devices are
simulated, and have trouble by its parameters.
"""


class SoleTopic(NamedTuple):
    """What the wheels obey: only the node with one role may publish it."""

    role: Role
    topic: str
    type_name: str
    names: frozenset[str]
    """Names of the node when no profile contains it."""


class PanelEntry(NamedTuple):
    """What a panel is called, and its topics."""

    title: str
    """The name in the list of lessons, to be translated."""
    needs: tuple[str, ...] = ()
    """Topics of others: if one of them exists, the panel has something to show."""


@dataclass(frozen=True)
class Robot:
    """One robot; a field that it does not give is empty."""

    roles: Mapping[str, tuple[Role, ...]] = field(default_factory=dict)
    """Of its nodes, by their modules; a profile may add others."""
    panels: Mapping[str, PanelEntry] = field(default_factory=dict)
    """In the order in which they are shown."""
    words: str = ""
    """Where it hears words, as std_msgs/String."""
    keys: str = ""
    """Where a person's keys drive it."""
    moving: frozenset[str] = frozenset()
    """Topics that move it, whatever their type."""
    sole: tuple[SoleTopic, ...] = ()
    of_many: frozenset[str] = frozenset()
    """Topics that several nodes publish together."""
    may_wait: frozenset[str] = frozenset()
    """Topics that need no publisher: people speak there, or drivers that a lesson may do without."""
    frames: Mapping[str, str] = field(default_factory=dict)
    """Of topics with distances and no header: where they are measured."""
    mounts: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Where these frames are if nobody says so: metres ahead of base_link, and the heading there."""
    story: tuple[str, ...] = ()
    """Topics that show what followed from a word; causes before effects, which decides the order of messages with
    the same time."""

    def named(self, node: str) -> tuple[Role, ...]:
        """Return the roles of a node of which no more than the name is known: those of the module of that name."""
        return next((roles for module, roles in self.roles.items() if module.rpartition(".")[2] == node), ())


@lru_cache
def robot() -> Robot:
    """Return the robot that is installed, an empty one if there is none."""
    try:
        found: Robot = import_module("robot.announced").ROBOT
    except ModuleNotFoundError as error:
        if error.name != "robot":
            raise
        return Robot()
    return found
