"""What the doctor examines, a function each: what it finds is said as it goes.

What a check reads is an argument with the real thing as its default, so that it can be tried for any machine.
"""

from __future__ import annotations

import codecs
import grp
import locale
import os
import platform
import pwd
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from brain.faults import ModelError
from brain.key import key_of
from brain.settings import load
from cli.doctor.finding import Finding, either, fail, ok, warn
from graph.distro import TESTED, wheel_of
from launcher.domain.discovery import set_discovery, why_open
from launcher.domain.domain import LAST_SAFE_DOMAIN, choose_domain, default_domain
from launcher.errors import DomainError, LauncherError
from launcher.rundir import check_writable, found_run_dir, log_path
from launcher.serial_ports import SerialPort, serial_ports
from text.i18n import LocalizedFloat, _, localized
from text.nested import read_json
from text.plain import plain

ROOT = Path("/")
_NOT_FROM_HERE = "import sys; sys.path[:] = [place for place in sys.path if place]\n"
"""`-c` would search the current folder for modules first, whatever is in it."""


def child_python(program: str, *arguments: str) -> list[str]:
    """Return the command line of a small program for another process, since it may hang or crash."""
    return [sys.executable, "-c", _NOT_FROM_HERE + program, *arguments]


def _text(path: Path) -> str:
    try:
        return path.read_text(errors="replace").strip("\0 \n")
    except OSError:
        return ""


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return ""


# ---------------------------------------------------------------- Python

FIRST, AFTER_LAST = (3, 10), (3, 14)
PACKAGES = ("textual", "pydantic", "PyYAML", "psutil", "numpy", "pyserial", "setproctitle")
"""Distributions without which the program or one of its packages cannot be imported."""


def python(
    version: Sequence[int] = sys.version_info[:3], system: str = "", version_of: Callable[[str], str] = _version
) -> Iterator[Finding]:
    text = _("Python {version} ({path})").format(version=".".join(map(str, version)), path=sys.executable)
    fix = _("use Python 3.10 to 3.13: make setup PYTHON=python3.12")
    yield ok("python", text) if FIRST <= tuple(version[:2]) < AFTER_LAST else fail("python", text, fix)
    system = system or platform.system()
    text = f"{system} {platform.machine()}"
    fix = _("Deck runs on Linux; on Windows inside WSL 2")
    yield ok("machine", text) if system == "Linux" else fail("machine", text, fix)
    missing = [name for name in PACKAGES if not version_of(name)]
    if missing:
        yield fail("packages", _("not installed: {names}").format(names=" ".join(missing)), _("run: make setup"))
    found, wanted = version_of("textual"), _pinned("textual")
    if wanted in ("", found):
        yield ok("textual", f"Textual {found}")
    else:
        text = _("Textual {version}, but Deck needs {wanted}").format(version=found or "-", wanted=wanted)
        yield warn("textual", text, f"pip install textual=={wanted}")


def _pinned(name: str) -> str:
    """Return the version that Deck requires, nothing if it is not known."""
    try:
        wishes = metadata.requires("deck-robot") or []
    except metadata.PackageNotFoundError:
        return ""
    pins = (wish.partition(";")[0].partition("==") for wish in wishes)
    return next((version.strip() for found, _eq, version in pins if found.strip() == name), "")


# ---------------------------------------------------------------- ROS

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


def probe() -> dict[str, Any]:
    """Import rclpy and the messages, and create a node: in a process of its own, as it may crash."""
    environ = dict(os.environ, ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    set_discovery(environ, "localhost")
    environ.pop("ROS_LOCALHOST_ONLY", None)
    command = child_python(PROBE, *MESSAGES)
    try:
        done = subprocess.run(command, capture_output=True, timeout=PROBE_WITHIN_S, env=environ, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        return {"error": str(error)}
    try:
        found: dict[str, Any] = read_json(done.stdout.decode(errors="replace").splitlines()[-1])
    except (ValueError, IndexError):
        words = done.stderr.decode(errors="replace").strip().splitlines()
        last = words[-1] if words else _("no reason given")
        return {"error": _("exit code {code}: {last}").format(code=done.returncode, last=last)}
    return found


def ros(
    ask: Callable[[], Mapping[str, Any]] = probe, environ: Mapping[str, str] = os.environ, machine: str = ""
) -> Iterator[Finding]:
    found = ask()
    rclpy, error = found.get("rclpy", ""), found.get("error", "")
    get_ros = _("use pixi run deck, or source /opt/ros/jazzy/setup.bash")
    if (machine or platform.machine()) == "x86_64":
        get_ros = _("run: make setup; or source /opt/ros/jazzy/setup.bash; or use pixi run deck")
    if not rclpy:
        yield fail("ros.rclpy", _("ROS 2: rclpy cannot be imported ({reason})").format(reason=error), get_ros)
        return
    text = f"ROS 2 {_origin(rclpy, environ)} ({rclpy})"
    fix = _("Deck is tested with jazzy and kilted only; others may work")
    yield either(environ.get("ROS_DISTRO", TESTED[0]) in TESTED, "ros.distro", text, fix)
    if error:
        fix = _("try: unset RMW_IMPLEMENTATION, or install that middleware")
        text = _("rclpy is installed, but no node can be created: {reason}").format(reason=error)
        yield fail("ros.rclpy", text, fix if "RMW_IMPLEMENTATION" in environ else get_ros)
    else:
        yield ok("ros.rclpy", _("rclpy can create a node, middleware {rmw}").format(rmw=found["rmw"]))
    missing = [name for name, why in found["messages"].items() if why]
    if missing:
        text = _("message packages cannot be imported: {names}").format(names=", ".join(missing))
        fix = _("run: make setup; with a ROS of your own: pip install ./interfaces, or colcon build")
        yield (fail if ESSENTIAL & set(missing) else warn)("ros.messages", text, fix)
    else:
        yield ok("ros.messages", _("all {count} message packages").format(count=len(found["messages"])))
    rviz2 = shutil.which("rviz2")
    lacks = _("RViz2 is not installed; lesson 6 works without it")
    yield ok("ros.rviz2", f"RViz2 ({rviz2})" if rviz2 else lacks)


def _origin(rclpy: str, environ: Mapping[str, str]) -> str:
    """Say where this ROS 2 comes from."""
    distro, conda = environ.get("ROS_DISTRO", ""), environ.get("CONDA_PREFIX", "")
    for name in TESTED:
        wheel = wheel_of(name)
        if wheel is not None and rclpy.startswith(str(wheel.locate_file(""))):
            return _("{distro}, wheels from PyPI (rclpy {version})").format(distro=name, version=wheel.version)
    if rclpy.startswith("/opt/ros/"):
        return _("{distro} from the distribution").format(distro=rclpy.split("/")[3])
    if conda and rclpy.startswith(conda):
        return _("{distro} from RoboStack (conda)").format(distro=distro or "jazzy")
    return _("{distro}, sourced").format(distro=distro or "?")


def network(environ: Mapping[str, str] = os.environ) -> Iterator[Finding]:
    """Say who can reach the ROS domain, according to the environment."""
    environ = {name: value for name, value in environ.items() if value}
    try:
        domain = choose_domain(None, None, environ)
    except DomainError as error:
        yield fail("ros.domain", localized(error.args[0]), _("run: unset ROS_DOMAIN_ID"))
    else:
        whose = "ROS_DOMAIN_ID" if "ROS_DOMAIN_ID" in environ else _("your own")
        text = _("domain {domain} ({whose}), visible on this machine only unless a profile says otherwise")
        text = text.format(domain=domain, whose=whose)
        fix = _("export ROS_DOMAIN_ID={domain}: ports of domains above {safe} may be taken")
        fix = fix.format(domain=default_domain(), safe=LAST_SAFE_DOMAIN)
        yield either(domain <= LAST_SAFE_DOMAIN, "ros.domain", text, fix)
    if environ.get("ROS_LOCALHOST_ONLY") == "1":
        text = _("ROS_LOCALHOST_ONLY=1 is obsolete and overrides ROS_AUTOMATIC_DISCOVERY_RANGE")
        yield warn("ros.localhost_only", text, _("unset it; Deck does so for its own nodes"))
    for name in ("ROS_DISCOVERY_SERVER", "CYCLONEDDS_URI"):
        if name in environ:
            text = _("{name}={value} changes which nodes see each other").format(name=name, value=environ[name])
            yield warn("ros.discovery", text, _("unset it if topics stay empty"))
    open_because = why_open(environ, "localhost")
    if open_because:
        yield warn("ros.open", localized(open_because), _("unset it if you do not need it"))


# ---------------------------------------------------------------- the terminal

LEAST = (80, 24)
TRUECOLOR_TERMS = ("-direct", "-truecolor", "kitty", "alacritty", "wezterm", "ghostty", "foot")
"""Words in the names of terminals that can show 16 million colours, even if Rich does not know."""


def terminal(
    environ: Mapping[str, str] = os.environ,
    encoding: str = "",
    size: tuple[int, int] | None = None,
    *,
    interactive: bool | None = None,
) -> Iterator[Finding]:
    """Say whether the screen can be drawn, and how well; `size` in columns and lines."""
    if interactive is None:
        interactive = sys.stdin.isatty() and sys.stdout.isatty()
    term = environ.get("TERM", "")
    if not interactive:
        yield ok("terminal", _("no terminal here: `deck run` works without one"))
    elif term in ("", "dumb"):
        text = _("TERM={term}: no screen can be drawn").format(term=term)
        yield warn("terminal", text, "export TERM=xterm-256color")
    else:
        yield ok("terminal", _("terminal {term}").format(term=term))
    encoding = encoding or sys.stdout.encoding or locale.getpreferredencoding(do_setlocale=False)
    with suppress(LookupError):
        encoding = codecs.lookup(encoding).name
    if encoding == "utf-8":
        yield ok("terminal.encoding", "UTF-8")
    else:
        text = _("the encoding is {encoding}: pictures and Russian will be unreadable")
        yield warn("terminal.encoding", text.format(encoding=encoding), "export LANG=C.UTF-8")
    if interactive:
        yield _colour(environ, term)
        columns, lines = size or shutil.get_terminal_size(fallback=(0, 0))
        text = _("{columns} columns, {lines} lines").format(columns=columns, lines=lines)
        fix = _("at least 80x24; 120x40 is comfortable")
        yield either(columns >= LEAST[0] and lines >= LEAST[1], "terminal.size", text, fix)


def _colour(environ: Mapping[str, str], term: str) -> Finding:
    """Say with which colours the screen is drawn; Rich decides, whatever the terminal can do."""
    from rich.console import Console

    if environ.get("NO_COLOR"):
        fix = _("unset NO_COLOR if you want colours")
        return warn("terminal.colour", _("NO_COLOR is set: no colours"), fix)
    depth = Console(force_terminal=True, _environ=environ).color_system
    if depth == "truecolor":
        return ok("terminal.colour", _("16 million colours"))
    fix = _("if the terminal can, export COLORTERM=truecolor (SSH does not pass it on)")
    if depth == "256":
        return warn("terminal.colour", _("256 colours: pictures look coarse"), fix)
    if not any(word in term for word in TRUECOLOR_TERMS):
        fix = _("if the terminal can, export TERM=xterm-256color")
    return warn("terminal.colour", _("16 colours or fewer: hues are hard to tell apart"), fix)


# ---------------------------------------------------------------- devices


def my_groups() -> set[str]:
    """Return the groups of this process: one joined recently only counts after logging in again."""
    return {_group(gid) for gid in os.getgroups()}


def _group(gid: int) -> str:
    try:
        return grp.getgrgid(gid).gr_name
    except KeyError:
        return str(gid)


def permission_fix(device: str) -> str:
    """Return how this user can get permission to open a device."""
    try:
        group = _group(os.stat(device).st_gid)  # noqa: PTH116 - a device, not a file to be read
    except OSError:
        group = "dialout"
    if group in my_groups():
        fix = _("you are in group {group}, but the port denies access: check its udev rule")
        return fix.format(group=group)
    fix = _("run: sudo usermod -aG {group} {user}, then log out and in again")
    return fix.format(group=group, user=os.environ.get("USER") or "$USER")


def may_use(device: str | Path) -> bool:
    return os.access(device, os.R_OK | os.W_OK)


def serial(
    find: Callable[[], Sequence[SerialPort]] = serial_ports, allowed: Callable[[str], bool] = may_use
) -> Iterator[Finding]:
    """Say which ports exist, by their permanent names, and whether they may be opened."""
    try:
        ports = find()
    except ImportError as error:
        yield warn("serial", str(error), "pip install pyserial")
        return
    if not ports:
        yield ok("serial", _("no serial port; mocks need none"))
    for port in ports:
        what = ", ".join(part for part in (port.description, localized(port.kind)) if part)
        text = _("serial port {name}").format(name=port.path) + (f" ({what})" if what else "")
        if allowed(port.device):
            yield ok("serial", text)
        else:
            yield warn("serial", _("{what}: no permission").format(what=text), permission_fix(port.device))


SPEECH = ("pocketsphinx", "espeakng_loader")
"""What the nodes `hearing` and `speaking` import."""
CARD = re.compile(r"^\s*\d+\s+\[[^]]*\]:\s*(.+)$", re.MULTILINE)


def media(root: Path = ROOT, allowed: Callable[[Path], bool] = may_use) -> Iterator[Finding]:
    """Look for cameras, sound cards and speech, which only the real robot needs."""
    cameras = sorted((root / "dev").glob("video[0-9]*"))
    if not cameras:
        yield ok("camera", _("no camera; mocks need none"))
    for camera in cameras:
        name = _text(root / "sys/class/video4linux" / camera.name / "name")
        text = _("camera {device} {name}").format(device=f"/dev/{camera.name}", name=name).rstrip()
        if allowed(camera):
            yield ok("camera", text)
        else:
            yield warn("camera", _("{what}: no permission").format(what=text), "sudo usermod -aG video $USER")
    cards = ", ".join(card.strip() for card in CARD.findall(_text(root / "proc/asound/cards")))
    if not cards:
        yield ok("sound", _("no sound card; mocks need none"))
    elif all(map(allowed, (root / "dev/snd").glob("pcm*"))):
        yield ok("sound", _("sound: {cards}").format(cards=cards))
    else:
        text = _("sound: {cards}: no permission").format(cards=cards)
        yield warn("sound", text, "sudo usermod -aG audio $USER")
    missing = [name for name in SPEECH if find_spec(name) is None]
    text = _("speech offline: in English; it speaks Russian too")
    if missing:
        text = _("speech offline: without {packages}; to hear and speak: {fix}")
    yield ok("speech", text.format(packages=", ".join(missing), fix="pip install 'deck-robot[voice]'"))


def _raspberry(root: Path) -> str:
    """Return the model of a Raspberry Pi, nothing on other machines."""
    model = _text(root / "proc/device-tree/model")
    return model if model.startswith("Raspberry Pi") else ""


NEEDED = ("dialout", "video", "audio")


def groups(root: Path = ROOT, mine: Collection[str] | None = None) -> Iterator[Finding]:
    """Look for the groups that a user of the real robot needs; on a Raspberry Pi, most likely the robot itself."""
    if not _raspberry(root):
        return
    try:
        user = pwd.getpwuid(os.getuid()).pw_name
    except KeyError:
        user = os.environ.get("USER", "")
    existing = {each.gr_name: each.gr_mem for each in grp.getgrall()}
    mine = {*my_groups(), _group(os.getgid())} if mine is None else mine
    missing = [name for name in NEEDED if name in existing and name not in mine]
    if os.getuid() == 0 or not missing:
        yield ok("groups", _("you may use serial ports, camera, sound"))
        return
    text = _("you are not in: {groups}").format(groups=", ".join(missing))
    if all(user in existing[name] for name in missing):
        yield warn("groups", text, _("log out and in again: you have already been added"))
    else:
        fix = _("run: sudo usermod -aG {group} {user}, then log out and in again")
        yield warn("groups", text, fix.format(group=",".join(missing), user=user or "$USER"))


# ---------------------------------------------------------------- power

LOW, LOW_BEFORE = 1 << 0, 1 << 16
HOT, HOT_BEFORE = 0b1110, 0b1110 << 16
"""Bits of `vcgencmd get_throttled`: capped, throttled, or at the soft temperature limit."""
ASK_WITHIN_S = 3.0
ADAPTS = ("intel_pstate", "amd-pstate", "amd-pstate-epp")
"""Drivers whose `powersave` still goes up to full speed under load."""


def ask_firmware() -> str:
    """Return a Raspberry Pi's report on its supply, empty if it cannot be asked."""
    command = ["vcgencmd", "get_throttled"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=ASK_WITHIN_S, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout


def power(root: Path = ROOT, ask: Callable[[], str] = ask_firmware) -> Iterator[Finding]:
    """Look for low voltage on a Raspberry Pi, and for power-saving governors."""
    pi = _raspberry(root)
    bits = _throttled(ask(), root) if pi else None
    if bits is not None:
        if bits & (LOW | LOW_BEFORE):
            text = _("low voltage now") if bits & LOW else _("low voltage since power-on")
            fix = _("use a 5 V, 5 A supply with its own cable, separate from the motors'")
            yield warn("power.voltage", f"{pi}: {text}", fix)
        if bits & (HOT | HOT_BEFORE):
            text = _("slowed down now") if bits & HOT else _("slowed down since power-on")
            fix = _("cool it: a fan, space around it; check with vcgencmd measure_temp")
            yield warn("power.throttled", f"{pi}: {text}", fix)
        if not bits & (LOW | LOW_BEFORE | HOT | HOT_BEFORE):
            yield ok("power.voltage", _("{pi}: power supply and temperature are fine").format(pi=pi))
    cpu = root / "sys/devices/system/cpu/cpu0/cpufreq"
    governor = _text(cpu / "scaling_governor")
    text = _("CPU governor {name}").format(name=governor)
    if governor == "powersave" and _text(cpu / "scaling_driver") not in ADAPTS:
        fix = _("echo ondemand | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor")
        text = _("{text}: the CPU stays slow, and commands arrive late").format(text=text)
        yield warn("power.governor", text, fix)
    elif governor:
        yield ok("power.governor", text)


def _throttled(answer: str, root: Path) -> int | None:
    """Return the bits of `throttled=0x50005`; without it, the state of the kernel's own sensor."""
    _name, _equals, bits = answer.strip().partition("=")
    try:
        return int(bits, 16)
    except ValueError:
        for sensor in root.glob("sys/class/hwmon/hwmon*"):
            if _text(sensor / "name") == "rpi_volt":
                return LOW if _text(sensor / "in0_lcrit_alarm") == "1" else 0
    return None


# ---------------------------------------------------------------- Deck itself

LEAST_FREE = 200 * 10**6
"""Bytes to keep free for logs; these are rotated but may still grow to a limit."""


def runs() -> Iterator[Finding]:
    """Look at Deck's directories, running sessions, and remains of earlier runs."""
    from launcher.client.client import running
    from launcher.runs.record import supervisors_everywhere
    from launcher.runs.strays import find_strays

    try:
        found_run_dir()
        logs = log_path()
        there = next(folder for folder in (logs, *logs.absolute().parents) if folder.exists())
        check_writable(there)
    except LauncherError as error:
        yield fail("folders", localized(error.args[0]), _("set DECK_RUN_DIR and DECK_LOG_DIR"))
        return
    free = shutil.disk_usage(there).free
    text = _("logs in {path}, {size:.1f} GB free").format(path=logs, size=LocalizedFloat(free / 1e9))
    yield either(free >= LEAST_FREE, "folders", text, _("remove old logs there, or set DECK_LOG_DIR"))
    sessions = running()
    names = ", ".join(f"{each.name} ({each.domain})" for each in sessions)
    yield ok("running", _("running: {names}").format(names=names) if names else _("no profile is running"))
    apart = []
    for one in supervisors_everywhere():
        if one.run_id not in {session.run_id for session in sessions}:
            record = one.record()
            name = record.session.name if record is not None else one.run_id
            words = _("{name} (domain {domain}, supervisor {pid})")
            apart.append(words.format(name=plain(name), domain=one.domain, pid=one.pid))
    if apart:
        text = _("also running, in a container or with another DECK_RUN_DIR: {names}")
        yield ok("apart", text.format(names=", ".join(apart)))
    strays = find_strays()
    if strays:
        text = _("left behind by an earlier run: {names}")
        fix = _("the screen offers to stop them; or: kill {pids}").format(
            pids=" ".join(str(one.pid) for one in strays)
        )
        yield warn("strays", text.format(names=", ".join(f"{one.node} ({one.pid})" for one in strays)), fix)


def model() -> Iterator[Finding]:
    """Say whether a language model is set up, without asking it; all lessons run without one as well."""
    try:
        settings = load()
        if settings is not None:
            key_of(settings)
    except ModelError as fault:
        text = _("language model: {problem}").format(problem=localized(fault.words))
        yield warn("model", text, localized(fault.fix))
    else:
        text = _("language model: none is set up, ai_brain follows its rules")
        if settings is not None:
            text = _("language model: {model} at {url} (deck doctor llm tries it)")
            text = text.format(model=settings.model, url=settings.base_url)
        yield ok("model", text)
    llama = _version("xllamacpp")
    text = _("no llama.cpp; only `deck model serve` needs it: {python} -m pip install xllamacpp")
    if llama:
        text = _("llama.cpp (xllamacpp {version}): `deck model serve` works")
    yield ok("model.llama", text.format(version=llama, python=shlex.quote(sys.executable)))


CHECKS: tuple[Callable[[], Iterator[Finding]], ...] = (
    *(python, ros, network, terminal, serial, media, groups, power, runs, model),
)


def examine() -> list[Finding]:
    return [finding for check in CHECKS for finding in check()]
