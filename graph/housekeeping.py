"""Tells which names in the ROS graph are ROS's own, so that lists can show only the robot's."""

from __future__ import annotations

from text.i18n import N_

TOPICS = frozenset({"/rosout", "/parameter_events", "/clock"})
SERVICES = frozenset(
    {
        *("describe_parameters", "get_parameter_types", "get_parameters", "get_type_description"),
        *("list_parameters", "set_parameters", "set_parameters_atomically", "get_logger_levels"),
        *("set_logger_levels", "get_available_states", "get_available_transitions", "get_transition_graph"),
    }
)
"""Last part of the names of services that rclpy and rclcpp give every node, or every one with a
lifecycle; not of `get_state` and `change_state`, which may be anybody's."""
PARAMETERS = (N_("If enabled, start the ~/get_type_description service."),)
"""rclpy's descriptions of the parameters that every node has, marked for the catalogue."""


def is_housekeeping(name: str) -> bool:
    """Return whether a topic, service or node of this full name exists without anybody's asking.

    Hidden names, those with a part that begins with an underscore, count too: the inner topics of
    actions, the nodes of command line tools.
    """
    return name in TOPICS or name.rpartition("/")[2] in SERVICES or is_hidden(name)


def is_hidden(name: str) -> bool:
    """Return whether a name has a part that begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))
