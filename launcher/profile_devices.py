"""Devices: settings that differ from robot to robot, kept in one place of a profile.

Nodes refer to them as `${devices.pico.port}` in `params`, `exec` and `env`; a variable
`DECK_PICO_PORT` in the environment overrides them without editing the file.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from launcher.profile_tree import Branch, Entry, Listing, Problems, Scalar, did_you_mean
from launcher.profile_yaml import read_value
from launcher.words import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from launcher.profile_tree import Tree, Where

REFERENCE = re.compile(r"\$\{devices\.([^}]*)\}")
REFERRING = ("params", "exec", "env")


def with_devices(tree: Branch, environ: Mapping[str, str], problems: Problems) -> Branch:
    """Return the profile with its devices overridden by `environ` and put in where named."""
    devices = tree.entries.get("devices")
    settings: dict[str, Scalar] = {}
    if devices is not None and isinstance(devices.value, Branch):
        tree = _replaced(tree, "devices", _overridden(devices.value, environ, problems, settings))
    nodes = tree.entries.get("nodes")
    if nodes is None or not isinstance(nodes.value, Branch):
        return tree
    filled = nodes.value
    for name, entry in nodes.value.entries.items():
        node = entry.value
        if isinstance(node, Branch):
            for key in set(REFERRING) & set(node.entries):
                where = ("nodes", name, key)
                value = _filled(node.entries[key].value, where, settings, problems)
                node = _replaced(node, key, value)
            filled = _replaced(filled, name, node)
    return _replaced(tree, "nodes", filled)


def variable(device: str, setting: str) -> str:
    """Return the name of the environment variable that overrides a setting."""
    return re.sub(r"\W", "_", f"DECK_{device}_{setting}".upper(), flags=re.ASCII)


def _replaced(branch: Branch, key: str, value: Tree) -> Branch:
    entries = dict(branch.entries)
    entries[key] = Entry(entries[key].key_place, value)
    return Branch(entries, branch.place)


def _overridden(
    devices: Branch, environ: Mapping[str, str], problems: Problems, settings: dict[str, Scalar]
) -> Branch:
    """Return the devices with the environment's values; fill `settings`, {"pico.port": ...}."""
    for device, entry in devices.entries.items():
        content = entry.value
        if not isinstance(content, Branch):
            continue
        for setting, inner in content.entries.items():
            value = inner.value
            name = variable(device, setting)
            if not isinstance(value, Scalar):
                message = say("expected a single value")
                problems.add(value.place, ("devices", device, setting), message)
                continue
            if name in environ:
                value = _from_environment(name, environ[name], value, problems)
            settings[f"{device}.{setting}"] = value
            content = _replaced(content, setting, value)
        devices = _replaced(devices, device, content)
    return devices


def _from_environment(name: str, text: str, declared: Scalar, problems: Problems) -> Scalar:
    """Read a variable as the type that the profile declares."""
    if isinstance(declared.value, str) or declared.value is None:
        return Scalar(text, text, declared.place)
    value = read_value(text, name, Problems())
    fits = isinstance(value, Scalar) and (
        type(value.value) is type(declared.value)
        or (isinstance(declared.value, float) and type(value.value) is int)
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


def _filled(tree: Tree, where: Where, settings: Mapping[str, Scalar], problems: Problems) -> Tree:
    if isinstance(tree, Branch):
        return Branch(
            {
                key: Entry(entry.key_place, _filled(entry.value, (*where, key), settings, problems))
                for key, entry in tree.entries.items()
            },
            tree.place,
        )
    if isinstance(tree, Listing):
        items = (
            _filled(item, (*where, index), settings, problems)
            for index, item in enumerate(tree.items)
        )
        return Listing(tuple(items), tree.place)
    if not isinstance(tree.value, str) or "${devices." not in tree.value:
        return tree
    return _filled_text(tree, where, settings, problems)


def _filled_text(
    scalar: Scalar, where: Where, settings: Mapping[str, Scalar], problems: Problems
) -> Scalar:
    text = scalar.text
    for name in REFERENCE.findall(text):
        if name not in settings:
            message = say("there is no device setting {name!r}", name=name)
            hint = did_you_mean(name, settings) or say("known are {keys}", keys=", ".join(settings))
            problems.add(scalar.place, where, message, hint if settings else "")
            return scalar
    whole = REFERENCE.fullmatch(text)
    if whole:
        found = settings[whole.group(1)]
        return Scalar(found.value, found.text, scalar.place)
    filled = REFERENCE.sub(lambda match: settings[match.group(1)].text, text)
    return Scalar(filled, filled, scalar.place)
