"""What the middleware says of a mistake in a line of the log, while the node runs on."""

from __future__ import annotations

import re
from typing import NamedTuple

from text.i18n import N_
from text.sentences import say

CHECK_FIELDS = "ROS_PYTHON_CHECK_FIELDS"
"""The variable that has messages of Jazzy check the values of their fields, if it is 1."""
LONGEST = 1000
"""Characters of an exception that are looked at."""


class Meaning(NamedTuple):
    """What a mistake of a beginner looks like, and what it means."""

    pattern: str
    """Of the exception with its text, or of a line of the log."""
    sentence: str
    """A template; its names are groups of the pattern."""


WARNINGS = (
    Meaning(r"incompatible QoS", N_("The QoS of publisher and subscription do not fit each other: nothing arrives.")),
    Meaning(
        r"Publisher already registered for (?:provided )?node name",
        N_("Two nodes have the same name: rename one of them."),
    ),
    Meaning(
        r"Callback returned an invalid type, it should return SetParameterResult",
        N_(
            "The callback of add_on_set_parameters_callback has to return"
            " SetParametersResult(successful=True), from rcl_interfaces.msg; without it no"
            " parameter changes."
        ),
    ),
)
"""Mistakes that show in a line of the log only, while the node runs on."""


def warning_of(line: str) -> str:
    """Return the sentence for a line of the log, empty if there is none."""
    for row in WARNINGS:
        found = re.search(row.pattern, line[:LONGEST])
        if found:
            return say(row.sentence, **found.groupdict())
    return ""
