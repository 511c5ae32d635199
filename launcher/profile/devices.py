"""Devices: settings that differ from robot to robot, in one place of a profile.

Nodes refer to them as `${devices.pico.port}` in `params`, `exec` and `env`; an environment variable
`DECK_PICO_PORT` overrides a setting without editing the file. Settings under `mock` or `real`
replace all others, the variable included, on that hardware only, so that a mock robot never drives
a real one. `port: auto` is resolved by USB ids (`launcher.profile.serial_choice`) just before the
profile is started. `${run_dir}` and `${domain}` are filled in as well.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from launcher.profile.reading import Problems, read_value, replaced
from launcher.profile.serial_choice import AUTO, KINDS, UnresolvedPort, WantedPort, choose, variable
from launcher.profile.when import HARDWARE, WhenError, holds
from launcher.serial_ports import SerialPort
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import Branch, Listing, MappingEntry, Scalar, Tree, Where, find, place_of, plain

LISTED = "usb"
"""The only setting that may be a list."""
DEVICE = re.compile(r"\$\{devices\.([^}]*)\}")
PLACE = re.compile(r"\$\{(\w+)\}")
REFERRING = ("params", "exec", "env")
"""The parts of a node in which references are filled in."""


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
    fill = _Filler({}, places, problems)
    devices = find(tree, ("devices",))
    if isinstance(devices, Branch):
        devices = fill.tree(devices, ("devices",))
        assert isinstance(devices, Branch)
        for device, entry in devices.entries.items():
            if isinstance(entry.value, Branch):
                own = _settings(device, entry.value, hardware, environ, problems)
                devices = replaced(devices, (device,), own)
        if ports is not None and hardware == "real":
            devices = _found(devices, used_devices(tree, hardware), ports, problems)
        tree = replaced(tree, ("devices",), devices)
        fill.settings = {
            f"{device}.{name}": entry.value
            for device, each in devices.entries.items()
            if isinstance(each.value, Branch)
            for name, entry in each.value.entries.items()
            if isinstance(entry.value, Scalar)
        }
    for name, key, part in _referring(tree):
        tree = replaced(tree, ("nodes", name, key), fill.tree(part, ("nodes", name, key)))
    return tree


def used_devices(tree: Branch, hardware: str) -> set[str]:
    """Return the devices that are referred to by nodes which run on this hardware."""
    return {
        match[1].partition(".")[0]
        for name, _key, part in _referring(tree)
        if _runs(find(tree, ("nodes", name, "when")), hardware)
        for text in _texts(part)
        for match in DEVICE.finditer(text)
    }


def _referring(tree: Branch) -> list[tuple[str, str, Tree]]:
    """Return the parts of nodes in which references may stand: node, key and what is there."""
    nodes = find(tree, ("nodes",))
    return [
        (name, key, entry.value.entries[key].value)
        for name, entry in (nodes.entries.items() if isinstance(nodes, Branch) else ())
        for key in REFERRING
        if isinstance(entry.value, Branch) and key in entry.value.entries
    ]


def _runs(when: Tree | None, hardware: str) -> bool:
    if not isinstance(when, Scalar) or not isinstance(when.value, str):
        return True
    try:
        return holds(when.value, {"hardware": hardware})
    except WhenError:
        return True  # Its fault is reported elsewhere.


def _texts(tree: Tree) -> Iterator[str]:
    if isinstance(tree, Scalar):
        if isinstance(tree.value, str):
            yield tree.value
        return
    for part in tree.items if isinstance(tree, Listing) else (entry.value for entry in tree.entries.values()):
        yield from _texts(part)


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
        value = Scalar(port.path, port.path, place_of(devices, where[1:]))
        devices = replaced(devices, where[1:], value)
    return devices


@dataclass
class _Filler:
    """Fills in values; an unknown name in `${}` is left as it is."""

    settings: Mapping[str, Scalar]
    """{"pico.port": ...}"""
    places: Mapping[str, str]
    """{"run_dir": ...}"""
    problems: Problems

    def tree(self, tree: Tree, where: Where) -> Tree:
        """Return it with everything filled in."""
        if isinstance(tree, Branch):
            entries = tree.entries.items()
            filled = {key: MappingEntry(e.key_place, self.tree(e.value, (*where, key))) for key, e in entries}
            return Branch(filled, tree.place)
        if isinstance(tree, Listing):
            items = (self.tree(item, (*where, index)) for index, item in enumerate(tree.items))
            return Listing(tuple(items), tree.place)
        return self._scalar(tree, where) if isinstance(tree.value, str) and "${" in tree.value else tree

    def _scalar(self, scalar: Scalar, where: Where) -> Scalar:
        text = PLACE.sub(lambda match: self.places.get(match[1], match[0]), scalar.text)
        for name in DEVICE.findall(text):
            if name not in self.settings:
                known = say("known: {keys}", keys=", ".join(self.settings)) if self.settings else ""
                hint = did_you_mean(name, self.settings) or known
                self.problems.add(scalar.place, where, say("there is no device setting {name!r}", name=name), hint)
                return scalar
        if whole := DEVICE.fullmatch(text):
            found = self.settings[whole[1]]
            return Scalar(found.value, found.text, scalar.place)
        filled = DEVICE.sub(lambda match: self.settings[match[1]].text, text)
        return scalar if filled == scalar.text else Scalar(filled, filled, scalar.place)
