"""Programs that tutorials of ROS start and that are not here, and where Deck does the same.

The words go into functions that shells call when they do not find a command, after which they ask
what the user's own settings have for that.
"""

from __future__ import annotations

import shlex

from text.i18n import N_, localized
from text.sentences import say

_SPACE = N_("the Space tab and `deck view` show frames, models and what sensors see")
_GRAPH = N_("the Flow and Graph tabs show who speaks to whom")
_SIMULATED = N_("`deck run robot` drives a simulated robot")
_DEPENDENCIES = N_("what the lessons need is here; other packages need a ROS 2 of your own")
_TYPES = N_("ROS 2 has `ros2 interface show`")
INSTEAD = {
    "rviz2": _SPACE, "rviz": _SPACE,
    "rqt": _GRAPH, "rqt_graph": _GRAPH,
    "rqt_console": N_("the Logs tab and `deck logs` show what the nodes log"),
    "rqt_plot": N_("the Topics tab shows values as they come"),
    "rqt_image_view": N_("the Topics tab shows pictures"),
    "plotjuggler": N_("the Topics tab shows values as they come"),
    "gazebo": _SIMULATED, "gz": _SIMULATED, "ign": _SIMULATED, "gzserver": _SIMULATED,
    "rosdep": _DEPENDENCIES, "vcs": _DEPENDENCIES,
    "rosbag": N_("`ros2 bag`, or `deck record` and `deck replay`"),
    "roscore": N_("ROS 2 has no master: nodes find each other by themselves"),
    "roslaunch": N_("a profile starts the nodes of a lesson together: `deck run`"),
    "rosrun": N_("ROS 2 has `ros2 run`"),
    "rostopic": N_("ROS 2 has `ros2 topic`"),
    "rosnode": N_("ROS 2 has `ros2 node`"),
    "rosservice": N_("ROS 2 has `ros2 service`"),
    "rosparam": N_("ROS 2 has `ros2 param`"),
    "rosmsg": _TYPES, "rossrv": _TYPES,
    "catkin_make": N_("ROS 2 builds with `colcon build`"),
    "catkin": N_("ROS 2 builds with `colcon build`"),
}  # fmt: skip
"""By the name of the program: what there is in its place, as a sentence to be translated."""
_POSIX = """\
deck_instead() {{
case $1 in
{cases}
*) return 1 ;;
esac
}}
"""
_BASH = """\
if declare -F command_not_found_handle >/dev/null; then
eval "deck_not_found_before$(declare -f command_not_found_handle | sed '1s/[^ (]*//')"
else
deck_not_found_before() { printf '%s: command not found\\n' "$1" >&2; return 127; }
fi
command_not_found_handle() { deck_instead "$1" && return 127; deck_not_found_before "$@"; }
"""
_ZSH = """\
if (( $+functions[command_not_found_handler] )); then
functions[deck_not_found_before]=$functions[command_not_found_handler]
else
deck_not_found_before() { print -u2 "zsh: command not found: $1"; return 127 }
fi
command_not_found_handler() { deck_instead "$1" && return 127; deck_not_found_before "$@" }
"""
_FISH = """\
functions -q fish_command_not_found; and functions -c fish_command_not_found deck_not_found_before
function fish_command_not_found
switch $argv[1]
{cases}
case '*'
functions -q deck_not_found_before; and deck_not_found_before $argv
end
end
"""


def for_bash() -> str:
    return _functions() + _BASH


def for_zsh() -> str:
    return _functions() + _ZSH


def for_fish() -> str:
    cases = (f"case {name}\necho {shlex.quote(line)} >&2" for name, line in _lines())
    return _FISH.format(cases="\n".join(cases))


def _functions() -> str:
    cases = (f"{name}) echo {shlex.quote(line)} >&2 ;;" for name, line in _lines())
    return _POSIX.format(cases="\n".join(cases))


def _lines() -> list[tuple[str, str]]:
    return [
        (name, localized(say("{name} is not in Deck: {instead}", name=name, instead=say(words))))
        for name, words in INSTEAD.items()
    ]
