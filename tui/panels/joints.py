"""Whether the joints that a panel shows come, or others do."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from text.i18n import _
from text.plain import plain
from tui.panels.other_type import other_type
from tui.widgets.drawing import Instead

if TYPE_CHECKING:
    from graph.data import Sample

TYPE = "sensor_msgs/msg/JointState"
ANOTHER_S = 2.0
"""So long after the last message that could be read it counts: two may publish by turns."""
LONGEST = 200


class Joints:
    """What came on a topic of JointState that should be about these joints."""

    def __init__(self, topic: str, awaited: Sequence[str]) -> None:
        """`awaited` are the joints of which at least one must be there."""
        self._topic, self._awaited = topic, tuple(awaited)
        self._read_s = -math.inf
        self._other: Sample | None = None

    def hear(self, sample: Sample, *, read: bool) -> None:
        """Take in a message, and whether it could be read."""
        if read:
            self._read_s, self._other = sample.received_s, None
        elif not 0.0 <= sample.received_s - self._read_s < ANOTHER_S:
            self._other = sample

    @property
    def instead(self) -> Instead | None:
        """What to say in place of values: which joints come, and which are awaited."""
        sample = self._other
        if sample is None:
            return None
        if (wrong := other_type(sample, TYPE)) is not None:
            return wrong
        found = sample.value.get("name")
        names = (
            plain(", ".join(map(str, found)), LONGEST) if isinstance(found, (list, tuple)) else ""
        )
        if not names:
            came = _("{topic}: no joint names have come").format(topic=self._topic)
        else:
            came = _("{topic}: {names} have come").format(topic=self._topic, names=names)
        awaited = _("expected: {names}").format(names=", ".join(self._awaited))
        return Instead(_("messages come, but with other joint names"), f"{came}; {awaited}")
