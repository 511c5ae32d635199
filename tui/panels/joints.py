"""Whether the joints that a panel shows are received, or others."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from text.i18n import _
from text.plain import plain
from tui.panels.other_type import other_type
from tui.widgets.drawing import Placeholder

if TYPE_CHECKING:
    from graph.data import Sample

TYPE = "sensor_msgs/msg/JointState"
ANOTHER_S = 2.0
"""A readable message counts for this long: two publishers may alternate."""
LONGEST = 200


class Joints:
    """Messages of a JointState topic that should be about these joints."""

    def __init__(self, topic: str, awaited: Sequence[str]) -> None:
        """Pass in `awaited` the joints of which at least one must be present."""
        self._topic, self._awaited = topic, tuple(awaited)
        self._read_s = -math.inf
        self._other: Sample | None = None

    def hear(self, sample: Sample, *, read: bool) -> None:
        """Take in a message, and whether it was readable."""
        if read:
            self._read_s, self._other = sample.received_s, None
        elif not 0.0 <= sample.received_s - self._read_s < ANOTHER_S:
            self._other = sample

    @property
    def placeholder(self) -> Placeholder | None:
        """What to show instead of values: which joints are received, and which are expected."""
        sample = self._other
        if sample is None:
            return None
        if (wrong := other_type(sample, TYPE)) is not None:
            return wrong
        found = sample.value.get("name")
        names = plain(", ".join(map(str, found)), LONGEST) if isinstance(found, (list, tuple)) else ""
        if not names:
            came = _("{topic}: received no joint names").format(topic=self._topic)
        else:
            came = _("{topic}: received {names}").format(topic=self._topic, names=names)
        awaited = _("expected: {names}").format(names=", ".join(self._awaited))
        return Placeholder(_("messages arrive, but with other joint names"), f"{came}; {awaited}")
