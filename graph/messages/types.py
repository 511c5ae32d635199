"""Finds the installed message, service and action types by name, or says what to install."""

from __future__ import annotations

import importlib
import threading
from functools import lru_cache
from typing import Any

from graph.distro import distro
from text.sentences import SaidError, Words, say
from text.suggestions import nearest

FEEDBACK = "_FeedbackMessage"
"""Suffix of the message type on an action's feedback topic."""
EVENT = "_Event"
"""Suffix of the message type in which a service publishes its calls, if it does."""
NAME_PARTS = 3
"""`std_msgs/msg/Float32`."""
_LOADING = threading.RLock()
ON_PYPI = frozenset(
    {
        *("action_msgs", "actionlib_msgs", "builtin_interfaces", "diagnostic_msgs", "geometry_msgs"),
        *("lifecycle_msgs", "nav_msgs", "rcl_interfaces", "rosgraph_msgs", "sensor_msgs", "service_msgs"),
        *("shape_msgs", "std_msgs", "std_srvs", "stereo_msgs", "test_msgs", "trajectory_msgs"),
        *("type_description_interfaces", "unique_identifier_msgs", "visualization_msgs"),
    }
)
"""Packages of messages of ROS 2 Jazzy on PyPI as of 2025-11, as `ros-jazzy-...`."""
OURS = frozenset({"deck_interfaces"})


class UnknownTypeError(SaidError):
    """No such type is installed here; str() says what to do about it."""


def kind_of(type_name: str, *kinds: str) -> str:
    """Return `msg`, `srv` or `action`, or of these `kinds` alone. Raises UnknownTypeError for any other name."""
    parts = type_name.split("/")
    kinds = kinds or ("msg", "srv", "action")
    if len(parts) == NAME_PARTS and parts[1] in kinds and all(part.isidentifier() for part in parts):
        return parts[1]
    raise UnknownTypeError(
        say("'{type}' is not the name of a type; write it as package/{kind}/Name", type=type_name, kind=kinds[0])
    )


@lru_cache(maxsize=512)
def load_message(type_name: str) -> type[Any]:
    """Return the class of a message such as `std_msgs/msg/Float32`.

    It also accepts the feedback of an action, `package/action/Name_FeedbackMessage`, and the event
    of a service, `package/srv/Name_Event`. Raises UnknownTypeError, also if the package exists but
    its import fails.
    """
    found: type[Any]
    if "/action/" in type_name and type_name.endswith(FEEDBACK):
        found = load_action(type_name.removesuffix(FEEDBACK)).Impl.FeedbackMessage
    elif "/srv/" in type_name and type_name.endswith(EVENT):
        found = load_service(type_name.removesuffix(EVENT)).Event
    else:
        return _load(type_name, "msg")
    _import_type_support(found)
    return found


@lru_cache(maxsize=128)
def load_service(type_name: str) -> type[Any]:
    """Return the class of a service such as `example_interfaces/srv/AddTwoInts`.

    It has the classes Request and Response. Raises UnknownTypeError.
    """
    return _load(type_name, "srv")


@lru_cache(maxsize=128)
def load_action(type_name: str) -> type[Any]:
    """Return the class of an action such as `deck_interfaces/action/DriveToPoint`.

    It has the classes Goal, Result and Feedback. Raises UnknownTypeError.
    """
    return _load(type_name, "action")


def _load(type_name: str, kind: str) -> type[Any]:
    kind_of(type_name, kind)
    package, _, name = type_name.split("/")
    try:
        importlib.import_module(package)
        module = importlib.import_module(f"{package}.{kind}")
        found: type[Any] | None = getattr(module, name, None)
        if found is not None:
            _import_type_support(found)
    except ModuleNotFoundError as error:
        if error.name == package:
            raise UnknownTypeError(_how_to_install(package)) from error
        raise UnknownTypeError(_missing(error, package, kind)) from error
    except Exception as error:
        # A broken package may raise anything, and must not take the observer down.
        reason = _broken(package, error)
        raise UnknownTypeError(reason) from error
    if found is None:
        raise UnknownTypeError(_no_such_name(module, package, kind, name))
    return found


def _import_type_support(found: Any) -> None:  # noqa: ANN401 - generated, without a base class
    """Load the C library behind a class now, where a failure can be reported.

    A class has its type support before the classes inside it have theirs: no other thread, which
    may be another observer's, must find it in between.
    """
    with _LOADING:
        if getattr(found, "_TYPE_SUPPORT", None) is None:
            found.__import_type_support__()


def _missing(error: ModuleNotFoundError, package: str, kind: str) -> Words:
    if error.name == f"{package}.{kind}":
        return {
            "msg": say("package {package} is installed and has no messages", package=package),
            "srv": say("package {package} is installed and has no services", package=package),
            "action": say("package {package} is installed and has no actions", package=package),
        }[kind]
    return _broken(package, error)


def not_subscribed(topic: str, type_name: str, error: Exception) -> Words:
    """Say that a topic cannot be subscribed, for example if its name has a second type."""
    return say("{topic} cannot be subscribed as {type}: {error}", topic=topic, type=type_name, error=error)


def not_decoded(type_name: str, error: Exception) -> Words:
    """Say that the bytes of a message are not of its type."""
    return say("a message of {type} cannot be decoded: {reason}", type=type_name, reason=error)


def _broken(package: str, error: Exception) -> Words:
    return say("package {package} is installed and cannot be used: {error}", package=package, error=error)


def _no_such_name(module: object, package: str, kind: str, name: str) -> Words:
    wanted = f"{kind}/{name}"
    meant = nearest(name, (each for each in dir(module) if each[0].isupper()))
    if not meant:
        return say("package {package} is installed in a version without {name}", package=package, name=wanted)
    return say(
        "package {package} is installed in a version without {name}; did you mean {near}?",
        package=package,
        name=wanted,
        near=f"{package}/{kind}/{meant}",
    )


def _how_to_install(package: str) -> Words:
    """Return words with the commands that install it.

    apt (packages.ros.org) and RoboStack have everything that is released into a ROS under the same
    name; whether this package is released cannot be known here.
    """
    if package in OURS:
        return say(
            "package {package} is not installed: it comes with Deck, build it from interfaces/", package=package
        )
    name = f"ros-{distro()}-{package.replace('_', '-')}"
    if package in ON_PYPI:
        return say(
            "package {package} is not installed: 'apt install {name}', 'pip install {name}' or "
            "'pixi add {name}', or build it and source its workspace",
            package=package,
            name=name,
        )
    return say(
        "package {package} is not installed: 'apt install {name}' or 'pixi add {name}', or build "
        "it and source its workspace",
        package=package,
        name=name,
    )
