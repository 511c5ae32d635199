"""Which module does which verb. One is loaded only when it is called: a command starts faster."""

from __future__ import annotations

from typing import Final

COMMANDS: Final = {
    "action": "Various action related sub-commands",
    "bag": "Various rosbag related sub-commands",
    "component": "Various component related sub-commands",
    "interface": "Show information about ROS interfaces",
    "lifecycle": "Various lifecycle related sub-commands",
    "node": "Various node related sub-commands",
    "param": "Various param related sub-commands",
    "pkg": "Various package related sub-commands",
    "run": "Run a package specific executable",
    "service": "Various service related sub-commands",
    "topic": "Various topic related sub-commands",
}
"""The commands, and what `ros2 --help` says of each."""

VERBS: Final[dict[tuple[str, str], str]] = {
    ("action", "info"): "action.info",
    ("action", "list"): "action.list",
    ("action", "send_goal"): "action.send_goal",
    ("action", "type"): "action.type",
    ("bag", "info"): "bag.info",
    ("bag", "play"): "bag.play",
    ("bag", "record"): "bag.record",
    ("component", "list"): "component.list",
    ("component", "types"): "component.types",
    ("interface", "list"): "interface.list",
    ("interface", "package"): "interface.package",
    ("interface", "packages"): "interface.packages",
    ("interface", "proto"): "interface.proto",
    ("interface", "show"): "interface.show",
    ("lifecycle", "get"): "lifecycle.get",
    ("lifecycle", "list"): "lifecycle.list",
    ("lifecycle", "nodes"): "lifecycle.nodes",
    ("lifecycle", "set"): "lifecycle.set",
    ("node", "info"): "node.info",
    ("node", "list"): "node.list",
    ("param", "delete"): "param.delete",
    ("param", "describe"): "param.describe",
    ("param", "dump"): "param.dump",
    ("param", "get"): "param.get",
    ("param", "list"): "param.list",
    ("param", "load"): "param.load",
    ("param", "set"): "param.set",
    ("pkg", "create"): "pkg.create",
    ("pkg", "executables"): "pkg.executables",
    ("pkg", "list"): "pkg.list",
    ("pkg", "prefix"): "pkg.prefix",
    ("pkg", "xml"): "pkg.xml",
    ("run", ""): "run",
    ("service", "call"): "service.call",
    ("service", "find"): "service.find",
    ("service", "list"): "service.list",
    ("service", "type"): "service.type",
    ("topic", "bw"): "topic.bw",
    ("topic", "delay"): "topic.delay",
    ("topic", "echo"): "topic.echo",
    ("topic", "find"): "topic.find",
    ("topic", "hz"): "topic.hz",
    ("topic", "info"): "topic.info",
    ("topic", "list"): "topic.list",
    ("topic", "pub"): "topic.pub",
    ("topic", "type"): "topic.type",
}
"""Command and verb, and the module in `ros2.verbs`. A command without verbs has the verb ''."""

ELSEWHERE: Final = {
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
PACKAGES_ELSEWHERE: Final = {
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

VERBS_ELSEWHERE: Final = {
    ("action", "find"): "The Graph tab lists actions by type; `ros2 action list -t` too.",
    ("bag", "convert"): "Deck reads and plays bags of either kind: mcap and sqlite3.",
    ("bag", "reindex"): "A bag that was cut short is read as far as it goes; `deck replay` too.",
    ("component", "load"): "`ros2 service call` asks the service ~/_container/load_node.",
    ("component", "unload"): "`ros2 service call` asks the service ~/_container/unload_node.",
    ("component", "standalone"): "Every node of Deck is a process: `ros2 run`.",
    ("bag", "burst"): "Replay in Deck steps message by message: `deck replay`.",
    ("service", "echo"): "The Graph tab shows the calls of a service and their answers.",
    ("service", "info"): "The Graph tab shows who serves a service and who calls it.",
}
"""Verbs of the real tool that are not here, and where Deck does the same."""
