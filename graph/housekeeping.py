"""Which names of the ROS graph are ROS's own, so that lists can show the robot's alone."""

from __future__ import annotations

from text.i18n import N_

TOPICS = frozenset({"/rosout", "/parameter_events", "/clock"})
SERVICES = frozenset(
    {
        "describe_parameters",
        "get_parameter_types",
        "get_parameters",
        "get_type_description",
        "list_parameters",
        "set_parameters",
        "set_parameters_atomically",
        "get_logger_levels",
        "set_logger_levels",
    }
)
"""Last part of the name of what rclpy and rclcpp give every node."""
PARAMETERS = (N_("If enabled, start the ~/get_type_description service."),)
"""What rclpy says of the parameters that every node has, marked for the catalogue."""


def is_housekeeping(name: str) -> bool:
    """Tell whether a topic, service or node of this full name is there without anybody's asking.

    Hidden names, those with a part that begins with an underscore, count as such: the inner topics
    of actions, the nodes of command line tools.
    """
    return name in TOPICS or name.rpartition("/")[2] in SERVICES or is_hidden(name)


def is_hidden(name: str) -> bool:
    """Tell whether a name has a part that begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))
