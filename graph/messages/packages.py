"""What to install for a missing message package, for each of the three ways to install ROS."""

from __future__ import annotations

from text.sentences import Words, say

ON_PYPI = frozenset(
    {
        "action_msgs",
        "actionlib_msgs",
        "builtin_interfaces",
        "diagnostic_msgs",
        "geometry_msgs",
        "lifecycle_msgs",
        "nav_msgs",
        "rcl_interfaces",
        "rosgraph_msgs",
        "sensor_msgs",
        "service_msgs",
        "shape_msgs",
        "std_msgs",
        "std_srvs",
        "stereo_msgs",
        "test_msgs",
        "trajectory_msgs",
        "type_description_interfaces",
        "unique_identifier_msgs",
        "visualization_msgs",
    }
)
"""Packages of messages of ROS 2 Jazzy on PyPI as of 2025-11, as `ros-jazzy-...`."""
OURS = frozenset({"deck_interfaces"})


def install_names(package: str) -> dict[str, str]:
    """Return the package's name for `pip`, `apt` and `pixi`; those without it are left out.

    apt (packages.ros.org) and RoboStack have everything that is released into Jazzy under the same
    name; whether this package is released cannot be known here.
    """
    if package in OURS:
        return {}
    name = f"ros-jazzy-{package.replace('_', '-')}"
    names = {"apt": name, "pixi": name}
    return {"pip": name, **names} if package in ON_PYPI else names


def how_to_install(package: str) -> Words:
    """Return words with the commands that install it."""
    names = install_names(package)
    if not names:
        return say(
            "package {package} is not installed: it comes with Deck, build it from interfaces/", package=package
        )
    if "pip" in names:
        return say(
            "package {package} is not installed: 'apt install {apt}', 'pip install {pip}' or "
            "'pixi add {pixi}', or build it and source its workspace",
            package=package,
            **names,
        )
    return say(
        "package {package} is not installed: 'apt install {apt}' or 'pixi add {pixi}', or build "
        "it and source its workspace",
        package=package,
        **names,
    )
