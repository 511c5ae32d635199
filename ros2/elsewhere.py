"""What the real tool has and this one has not, and where Deck does the same."""

from __future__ import annotations

from typing import Final

COMMANDS: Final = {
    "component": "Every node of Deck is a process of its own; "
    "`ros2 service call` asks the services of a container, such as ~/_container/list_nodes.",
    "control": "Deck knows no ros2_control; the Devices tab shows joints and drives.",
    "daemon": "This ros2 has no daemon: it looks at the graph anew each time.",
    "doctor": "Ask `deck doctor` instead, of the graph `deck doctor --graph`.",
    "launch": "A profile starts the nodes of a lesson together: `deck run`, or the Deck tab.",
    "multicast": "Ask `deck doctor` instead.",
    "security": "Deck has no screen for security enclaves.",
    "wtf": "Ask `deck doctor` instead, of the graph `deck doctor --graph`.",
}
"""Commands of the real tool that are not here, and where Deck does the same."""

_TALK = (
    "`deck run 1` runs the nodes of lesson 1, `deck new --node my_talker` writes one of your own, "
    "`ros2 topic pub` and `ros2 topic echo` talk and listen."
)
PACKAGES: Final = {
    "demo_nodes_cpp": _TALK,
    "demo_nodes_py": _TALK,
    "examples_rclpy_minimal_publisher": _TALK,
    "rqt_graph": "The Flow and Graph tabs show who speaks to whom.",
    "rqt_console": "The Logs tab shows what the nodes log.",
    "rqt_plot": "The Topics tab shows values as they come.",
    "rviz2": "The Space tab and `deck view` show frames, models and what sensors see.",
    "turtlesim": "`deck run robot` drives a simulated robot.",
}
"""Packages that tutorials run and that are not here, and where Deck does the same."""

_ALIKE = "`ros2 {} list -t` names all of them with their types, as does the Graph tab."
VERBS: Final = {
    ("action", "find"): _ALIKE.format("action"),
    ("bag", "convert"): "Deck reads and plays bags of either kind: mcap and sqlite3.",
    ("bag", "reindex"): "A bag that was cut short is read as far as it goes; `deck replay` too.",
    ("bag", "burst"): "Replay in Deck steps message by message: `deck replay`.",
    ("interface", "list"): "The Graph tab finds types by any part of their names.",
    ("interface", "package"): "The Graph tab finds types by any part of their names.",
    ("interface", "packages"): "The Graph tab finds types by any part of their names.",
    ("interface", "proto"): "The Topics and Graph tabs fill in a form; `ros2 interface show` has the fields.",
    ("lifecycle", "list"): "`J` in the Graph tab offers the transitions that are possible now.",
    ("lifecycle", "nodes"): "The Graph tab shows the state of each node that has a lifecycle.",
    ("param", "delete"): "A parameter is undeclared by its node alone; `ros2 param set` changes it.",
    ("param", "load"): "The Graph tab loads a file; `ros2 run` takes --ros-args --params-file FILE.",
    ("pkg", "list"): "`ros2 pkg executables` names the packages that have programs.",
    ("pkg", "prefix"): "`ros2 pkg executables PACKAGE --full-path` tells where its programs are.",
    ("pkg", "xml"): "It is the file package.xml in share/PACKAGE of the folder that the package is installed in.",
    ("service", "echo"): "The Graph tab shows the calls of a service and their answers.",
    ("service", "find"): _ALIKE.format("service"),
    ("service", "info"): "The Graph tab shows who serves a service and who calls it.",
    ("topic", "bw"): "The Topics tab shows rate and bytes a second of each topic.",
    ("topic", "delay"): "The Topics tab shows how old the newest message is.",
    ("topic", "find"): _ALIKE.format("topic"),
}
"""Verbs of the real tool that are not here, and where Deck does the same."""
