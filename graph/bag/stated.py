"""What a bag's `metadata.yaml` says, of any version of rosbag2, as far as it can be understood."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PureWindowsPath
from typing import TYPE_CHECKING, Any

from graph.bag.offers import Offer, offer_in
from text.nested_yaml import read_yaml
from text.os_words import os_reason
from text.sentences import Words, say

if TYPE_CHECKING:
    from pathlib import Path

METADATA = "metadata.yaml"


@dataclass(frozen=True)
class StatedTopic:
    """A topic in the metadata."""

    name: str
    type_name: str
    messages: int
    encoding: str
    offer: Offer


@dataclass(frozen=True)
class Stated:
    """The metadata of a bag."""

    storage: str = ""
    files: tuple[str, ...] = ()
    """Names of its files: the first rosbag2 put the folder in front, readers ignore that."""
    messages: int | None = None
    topics: tuple[StatedTopic, ...] = ()
    seconds: float | None = None
    compression: str = ""
    """Of files or messages: `zstd`; empty for none."""
    distro: str = ""
    trouble: Words | None = None
    """Why nothing is known though there is a file."""


def stated_in(folder: Path) -> Stated | None:
    """Return what the folder's metadata say, None if there are none."""
    import yaml

    file = folder / METADATA
    try:
        # Not `exists`: what cannot be looked at is not missing.
        found = read_yaml(file.read_text(encoding="utf-8"))
        inner = found["rosbag2_bagfile_information"]
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        reason = os_reason(error)
        return Stated(trouble=say("metadata.yaml cannot be read: {reason}", reason=reason))
    except (yaml.YAMLError, KeyError, TypeError, ValueError):
        inner = None
    if not isinstance(inner, Mapping):
        return Stated(trouble=say("metadata.yaml is damaged: only the files themselves count"))
    return _stated(inner)


def _stated(inner: Mapping[str, Any]) -> Stated:
    mode = _text(inner.get("compression_mode")).lower()
    names = _listed(inner.get("relative_file_paths"))
    duration = inner.get("duration")
    nanoseconds = _whole(duration.get("nanoseconds")) if isinstance(duration, Mapping) else None
    topics = (_topic(each) for each in _listed(inner.get("topics_with_message_count")))
    return Stated(
        storage=_text(inner.get("storage_identifier")),
        files=tuple(PureWindowsPath(str(name)).name for name in names),
        messages=_whole(inner.get("message_count")),
        topics=tuple(topic for topic in topics if topic is not None),
        seconds=None if nanoseconds is None else nanoseconds / 1e9,
        compression=_text(inner.get("compression_format")) if mode not in {"", "none"} else "",
        distro=_text(inner.get("ros_distro")),
    )


def _topic(each: object) -> StatedTopic | None:
    about = each.get("topic_metadata") if isinstance(each, Mapping) else None
    if not isinstance(each, Mapping) or not isinstance(about, Mapping) or "name" not in about:
        return None
    return StatedTopic(
        _text(about["name"]),
        _text(about.get("type")),
        _whole(each.get("message_count")) or 0,
        _text(about.get("serialization_format")),
        offer_in(about.get("offered_qos_profiles")),
    )


def _listed(value: object) -> list[object]:
    return value if isinstance(value, list) else []


def _text(value: object) -> str:
    return "" if value is None else str(value)


def _whole(value: object) -> int | None:
    return value if isinstance(value, int) and not isinstance(value, bool) else None
