"""Devices: settings that differ from robot to robot, in one place of a profile.

Nodes refer to them as `${devices.pico.port}` in `params`, `exec` and `env`; an environment variable
`DECK_PICO_PORT` overrides a setting without editing the file. Settings under `mock` or `real`
replace all others, the variable included, on that hardware only, so that a mock robot never drives
a real one. `port: auto` is resolved by USB ids (`launcher.profile.serial_choice`) just before the
profile is started.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from launcher.profile.device_variables import variable
from launcher.profile.problems import Problems
from launcher.profile.reading import read_value
from launcher.profile.references import Filler, used_devices
from launcher.profile.serial_choice import AUTO, KINDS, UnresolvedPort, WantedPort, choose
from launcher.profile.when import HARDWARE
from text.sentences import say
from text.yaml_tree import Branch, Listing, MappingEntry, Scalar, find, place_of, plain

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from launcher.serial_ports import SerialPort
    from text.yaml_tree import Tree

LISTED = "usb"
"""The only setting that may be a list."""


def with_devices(
    tree: Branch,
    hardware: str,
    places: Mapping[str, str],
    environ: Mapping[str, str],
    problems: Problems,
    ports: Callable[[], Sequence[SerialPort]] | None = None,
) -> Branch:
    """Return the profile with the devices of this hardware, and with references to them filled in.

    Args:
        tree: the profile
        hardware: `mock` or `real`
        places: other names that may be referred to, {"run_dir": "/run/user/1000/deck"}
        environ: where DECK_* variables are read from
        problems: collects what is wrong
        ports: lists the serial ports; None leaves `auto` as it is
    """
    devices = tree.entries.get("devices")
    settings: dict[str, Scalar] = {}
    if devices is not None and isinstance(devices.value, Branch):
        branch = Filler({}, places, problems).branch(devices.value, ("devices",))
        branch = _overridden(branch, hardware, environ, problems)
        if ports is not None and hardware == "real":
            branch = _found(branch, used_devices(tree, hardware), ports, problems)
        tree = _replaced(tree, "devices", branch)
        settings = {
            f"{device}.{name}": entry.value
            for device, each in branch.entries.items()
            if isinstance(each.value, Branch)
            for name, entry in each.value.entries.items()
            if isinstance(entry.value, Scalar)
        }
    nodes = tree.entries.get("nodes")
    if nodes is None or not isinstance(nodes.value, Branch):
        return tree
    return _replaced(tree, "nodes", Filler(settings, places, problems).nodes(nodes.value))


def wanted(devices: Mapping[str, Mapping[str, Any]]) -> dict[str, WantedPort]:
    """Return what devices like {"pico": {"port": "auto", "kind": "pico"}} say about their ports."""
    found: dict[str, WantedPort] = {}
    for device, settings in devices.items():
        port = settings.get("port") if isinstance(settings, dict) else None
        if not isinstance(port, str):
            continue
        ids = settings.get(LISTED) or KINDS.get(str(settings.get("kind", "")), ())
        ids = (ids,) if isinstance(ids, str) else ids
        path = port if port == AUTO else os.path.realpath(port)
        found[device] = WantedPort(path, tuple(str(each).lower() for each in ids))
    return found


def _replaced(branch: Branch, key: str, value: Tree) -> Branch:
    entries = dict(branch.entries)
    entries[key] = MappingEntry(entries[key].key_place, value)
    return Branch(entries, branch.place)


def _overridden(devices: Branch, hardware: str, environ: Mapping[str, str], problems: Problems) -> Branch:
    """Return the devices with the values from the environment and for this hardware."""
    for device, entry in devices.entries.items():
        if isinstance(entry.value, Branch):
            settings = _settings(device, entry.value, hardware, environ, problems)
            devices = _replaced(devices, device, settings)
    return devices


def _settings(device: str, written: Branch, hardware: str, environ: Mapping[str, str], problems: Problems) -> Branch:
    settings: dict[str, MappingEntry] = {}
    for name, entry in written.entries.items():
        if name not in HARDWARE and _single(entry.value, ("devices", device, name), problems):
            overriding = variable(device, name)
            value = entry.value
            if isinstance(value, Scalar) and overriding in environ:
                value = _from_environment(overriding, environ[overriding], value, problems)
            settings[name] = MappingEntry(entry.key_place, value)
    special = find(written, (hardware,))
    if isinstance(special, Branch):
        settings |= {
            name: entry
            for name, entry in special.entries.items()
            if _single(entry.value, ("devices", device, hardware, name), problems)
        }
    return Branch(settings, written.place)


def _single(value: Tree, where: tuple[str, ...], problems: Problems) -> bool:
    """Whether a setting is a single value, as all but the USB ids must be."""
    if isinstance(value, Scalar) or (where[-1] == LISTED and isinstance(value, Listing)):
        return True
    problems.add(value.place, where, say("expected a single value"))
    return False


def _from_environment(name: str, text: str, declared: Scalar, problems: Problems) -> Scalar:
    """Read a variable as the type that the value in the profile has."""
    if isinstance(declared.value, str) or declared.value is None:
        return Scalar(text, text, declared.place)
    value = read_value(text, name, Problems())
    fits = isinstance(value, Scalar) and (
        type(value.value) is type(declared.value) or (isinstance(declared.value, float) and type(value.value) is int)
    )
    if not fits or not isinstance(value, Scalar):
        message = say(
            "the variable {name}={text} replaces {declared}, but is of another type",
            name=name,
            text=text,
            declared=declared.text,
        )
        problems.add(declared.place, (), message)
        return declared
    return Scalar(value.value, text, declared.place)


def _found(devices: Branch, used: set[str], ports: Callable[[], Sequence[SerialPort]], problems: Problems) -> Branch:
    """Return the devices with `auto` replaced by the ports that were found."""
    asked = {name: each for name, each in wanted(plain(devices)).items() if name in used}
    if not any(each.port == AUTO for each in asked.values()):
        return devices
    for device, port in choose(asked, ports()).items():
        where = ("devices", device, "port")
        if isinstance(port, UnresolvedPort):
            problems.add(place_of(devices, where[1:]), where, port.message, port.hint)
            continue
        branch = devices.entries[device].value
        if isinstance(branch, Branch):
            value = Scalar(port.path, port.path, place_of(branch, ("port",)))
            devices = _replaced(devices, device, _replaced(branch, "port", value))
    return devices
