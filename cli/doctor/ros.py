"""Which ROS 2 is installed and whether it works: tested in a separate process, as it may crash."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass, field
from importlib import metadata
from typing import TYPE_CHECKING, Any

from cli.child_python import python
from cli.doctor.finding import fail, ok, warn
from launcher.domain.discovery import set_discovery
from text.i18n import _
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Mapping

    from cli.doctor.finding import Finding

MESSAGES = (
    *("std_msgs", "sensor_msgs", "geometry_msgs", "nav_msgs", "diagnostic_msgs"),
    *("tf2_msgs", "ackermann_msgs", "example_interfaces", "deck_interfaces"),
)
ESSENTIAL = {"std_msgs", "sensor_msgs"}
"""Without these the screen cannot even read the topics of the first lessons."""
PROBE_WITHIN_S = 30.0
PROBE = """
import json, sys, importlib
found = {"rclpy": "", "rmw": "", "error": "", "messages": {}}
try:
    import rclpy
    found["rclpy"] = rclpy.__file__
    found["rmw"] = rclpy.get_rmw_implementation_identifier()
    rclpy.init(args=[])
    rclpy.create_node("deck_doctor", enable_rosout=False, start_parameter_services=False)
    rclpy.shutdown()
except BaseException as error:
    found["error"] = f"{type(error).__name__}: {error}"
for name in sys.argv[1:]:
    for part in ("msg", "srv", "action"):
        try:
            importlib.import_module(f"{name}.{part}")
            found["messages"][name] = ""
            break
        except ModuleNotFoundError as error:
            found["messages"].setdefault(name, str(error))
        except BaseException as error:
            found["messages"][name] = f"{type(error).__name__}: {error}"
            break
sys.stdout.write("\\n" + json.dumps(found))
"""


@dataclass(frozen=True)
class RosFacts:
    """The ROS found."""

    rclpy: str = ""
    """Path of the module, empty if it is not installed."""
    rmw: str = ""
    """The middleware in use: `rmw_fastrtps_cpp`."""
    error: str = ""
    """Why no node could be created, empty if one could."""
    messages: Mapping[str, str] = field(default_factory=dict)
    """Package to why it cannot be imported, empty if it can."""
    environ: Mapping[str, str] = field(default_factory=dict)
    machine: str = "x86_64"
    wheels: str = ""
    """Version of the wheel that rclpy came in, empty if it is not from a wheel."""
    rviz2: str = ""
    """Path of the command, empty if it is not installed."""


def collect() -> RosFacts:
    """Gather the facts: import rclpy and the messages, and create a node, in a separate process."""
    found = _probe()
    names = ("ROS_DISTRO", "AMENT_PREFIX_PATH", "CONDA_PREFIX", "RMW_IMPLEMENTATION")
    return RosFacts(
        rclpy=found.get("rclpy", ""),
        rmw=found.get("rmw", ""),
        error=found.get("error", ""),
        messages=found.get("messages", {}),
        environ={name: os.environ[name] for name in names if name in os.environ},
        machine=os.uname().machine,
        wheels=_wheel(found.get("rclpy", "")),
        rviz2=shutil.which("rviz2") or "",
    )


def diagnose(facts: RosFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    if not facts.rclpy:
        text = _("ROS 2: rclpy cannot be imported ({reason})").format(reason=facts.error)
        return [fail("ros.rclpy", text, how_to_get(facts))]
    return [_origin(facts), *_node(facts), *_messages(facts), _rviz(facts)]


def origin(facts: RosFacts) -> str:
    """Describe where this ROS 2 comes from."""
    distro = facts.environ.get("ROS_DISTRO", "")
    if facts.wheels:
        return _("jazzy, wheels from PyPI (rclpy {version})").format(version=facts.wheels)
    if facts.rclpy.startswith("/opt/ros/"):
        return _("{distro} from the distribution").format(distro=facts.rclpy.split("/")[3])
    conda = facts.environ.get("CONDA_PREFIX", "")
    if conda and facts.rclpy.startswith(conda):
        return _("{distro} from RoboStack (conda)").format(distro=distro or "jazzy")
    return _("{distro}, sourced").format(distro=distro or "?")


def how_to_get(facts: RosFacts) -> str:
    """Return the fix for a missing ROS 2, depending on the machine."""
    if facts.machine == "x86_64":
        return _("run: make setup; or source /opt/ros/jazzy/setup.bash; or use pixi run deck")
    return _("use pixi run deck, or source /opt/ros/jazzy/setup.bash")


def _origin(facts: RosFacts) -> Finding:
    text = f"ROS 2 {origin(facts)} ({facts.rclpy})"
    distro = facts.environ.get("ROS_DISTRO", "jazzy")
    if distro != "jazzy":
        fix = _("Deck is tested with jazzy only; others may work")
        return warn("ros.distro", text, fix)
    return ok("ros.distro", text)


def _node(facts: RosFacts) -> list[Finding]:
    if facts.error:
        fix = _("try: unset RMW_IMPLEMENTATION, or install that middleware")
        if "RMW_IMPLEMENTATION" not in facts.environ:
            fix = how_to_get(facts)
        text = _("rclpy is installed, but no node can be created: {reason}").format(reason=facts.error)
        return [fail("ros.rclpy", text, fix)]
    return [ok("ros.rclpy", _("rclpy can create a node, middleware {rmw}").format(rmw=facts.rmw))]


def _messages(facts: RosFacts) -> list[Finding]:
    missing = {name: why for name, why in facts.messages.items() if why}
    if not missing:
        count = len(facts.messages)
        return [ok("ros.messages", _("all {count} message packages").format(count=count))]
    names = ", ".join(missing)
    text = _("message packages cannot be imported: {names}").format(names=names)
    fix = _("run: make setup; with a ROS of your own: pip install ./interfaces, or colcon build")
    made = fail if ESSENTIAL & set(missing) else warn
    return [made("ros.messages", text, fix)]


def _rviz(facts: RosFacts) -> Finding:
    if facts.rviz2:
        return ok("ros.rviz2", f"RViz2 ({facts.rviz2})")
    return ok("ros.rviz2", _("RViz2 is not installed; lesson 6 works without it"))


def _wheel(rclpy: str) -> str:
    """Return the version of the installed wheel, if it is the one that was imported."""
    try:
        wheel = metadata.distribution("ros-jazzy-rclpy")
    except metadata.PackageNotFoundError:
        return ""
    return wheel.version if rclpy.startswith(str(wheel.locate_file(""))) else ""


def _probe() -> dict[str, Any]:
    environ = dict(os.environ, ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    set_discovery(environ, "localhost")
    environ.pop("ROS_LOCALHOST_ONLY", None)
    try:
        done = subprocess.run(
            python(PROBE, *MESSAGES), capture_output=True, timeout=PROBE_WITHIN_S, env=environ, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return {"error": str(error)}
    try:
        found: dict[str, Any] = read_json(done.stdout.decode(errors="replace").splitlines()[-1])
    except (ValueError, IndexError):
        words = done.stderr.decode(errors="replace").strip().splitlines()
        last = words[-1] if words else _("no reason given")
        return {"error": _("exit code {code}: {last}").format(code=done.returncode, last=last)}
    return found
