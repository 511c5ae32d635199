"""The definitions of message types as text, as a bag stores them for its readers.

They come from the library's own store of ROS 2 Jazzy; types unknown to it come from the `.msg`
files of the installed packages, or, where a package has none, are made from the fields of a class.
"""

from __future__ import annotations

import os
import re
import sys
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graph.messages.fields import FieldType, parse
from graph.messages.types import load_action, load_message, load_service

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

SEPARATOR = "=" * 80
MSG_NAMES = {"boolean": "bool", "float": "float32", "double": "float64", "octet": "byte"}
"""The generator's name of a plain type to its name in a `.msg` file."""
PLAIN = frozenset(
    {
        *("bool", "byte", "char", "float32", "float64", "string", "wstring"),
        *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
    }
)
PARTS = {"Feedback": "action", "Request": "srv", "Response": "srv"}
"""The kind of interface that a generated message belongs to, by the suffix of its name."""
_TYPE = re.compile(r"^\s*(?P<name>[A-Za-z][\w/]*)")
_CONSTANT = re.compile(r"^\s*\S+\s+\w+\s*=")


def definition(type_name: str, digest: str = "") -> str:
    """Return the text of a type, followed by those of the types in it.

    `digest`, `RIHS01_...`, is the publisher's hash of its type: a definition in the store with
    another hash is not used. Raises UnknownTypeError for a type that is not installed.
    """
    store = jazzy()
    if type_name in store.fielddefs and digest in {"", store.hash_rihs01(type_name)}:
        return store.generate_msgdef(type_name, ros_version=2)[0]
    return _gathered(type_name)


def hash_of(type_name: str) -> str:
    """Return the hash of a type in the store, empty for any other."""
    store = jazzy()
    return store.hash_rihs01(type_name) if type_name in store.fielddefs else ""


@lru_cache(maxsize=1)
def jazzy() -> Typestore:
    """Return the library's types of ROS 2 Jazzy; a tenth of a second the first time."""
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


def _gathered(type_name: str) -> str:
    """Return the installed text of a type, followed by every type that it needs."""
    texts: dict[str, str] = {}
    wanted = [type_name]
    while wanted:
        name = wanted.pop(0)
        if name not in texts:
            texts[name] = _installed(name)
            wanted += _needed(name, texts[name])
    first, *others = texts.items()
    below = (f"{SEPARATOR}\nMSG: {name.replace('/msg/', '/')}\n{text}" for name, text in others)
    return "".join((first[1], *below))


def _installed(type_name: str) -> str:
    package, kind, name = type_name.split("/")
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), sys.prefix]
    for prefix in filter(None, prefixes):
        path = Path(prefix, "share", package, kind, f"{name}.msg")
        if path.is_file():
            return path.read_text(encoding="utf-8", errors="replace").rstrip() + "\n"
    fields: dict[str, str] = _class(type_name).get_fields_and_field_types()
    return "".join(f"{_written(parse(kind))} {name}\n" for name, kind in fields.items())


def _class(type_name: str) -> Any:  # noqa: ANN401 - generated, without a base class
    """Return the class of a message, which may be an inner part of an action or a service."""
    whole, _, part = type_name.rpartition("_")
    if whole and part in PARTS:
        owner = load_action(whole) if PARTS[part] == "action" else load_service(whole)
        return getattr(owner, part)
    return load_message(type_name)


def _written(kind: FieldType) -> str:
    """Return how a `.msg` file writes the type of a field."""
    element = MSG_NAMES.get(kind.element, kind.element)
    if (of := PARTS.get(element.rpartition("_")[2])) is not None:
        # In full: readers take a shorter name for a message's, which has another hash.
        element = element.replace("/", f"/{of}/", 1)
    if kind.text_limit is not None:
        element += f"<={kind.text_limit}"
    if not kind.is_many:
        return element
    if kind.size is not None:
        return f"{element}[{kind.size}]"
    return f"{element}[<={kind.limit}]" if kind.limit is not None else f"{element}[]"


def _needed(type_name: str, text: str) -> list[str]:
    """Return the full names of the messages among the fields of a definition."""
    found = []
    for line in text.splitlines():
        match = _TYPE.match(line.partition("#")[0])
        if match is None or match["name"] in PLAIN or _CONSTANT.match(line):
            continue
        parts = match["name"].split("/")
        if parts == ["Header"]:
            parts = ["std_msgs", "Header"]
        if len(parts) == 1:
            parts = [type_name.split("/", maxsplit=1)[0], *parts]
        found.append("/".join(parts) if len(parts) > 2 else "/msg/".join(parts))
    return found
