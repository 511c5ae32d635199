"""Reads recorded bags: a rosbag2 directory (MCAP, sqlite3) or a bare MCAP file.

A bag that was cut short, by a crash or a full disk, is read as far as it goes, and says so.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graph.bag.decoding import TypeText
from graph.bag.defects import defect_of
from graph.bag.errors import BagError, no_bag, unreadable
from text.nested import read_yaml
from text.sentences import Words, say

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from typing_extensions import Self

    from graph.bag.files import BagReader

METADATA = "metadata.yaml"
STORAGES = ("mcap", "sqlite3")
SUFFIXES = {".mcap": "mcap", ".db3": "sqlite3"}


@dataclass(frozen=True)
class TopicInBag:
    """One topic of a bag, of one type."""

    name: str
    kind: TypeText
    messages: int
    reliability: str = ""
    durability: str = ""
    """QoS offered by its first publisher: `reliable`, `volatile`; empty if the bag does not say."""


class Bag:
    """An open bag; close it, or use it in a `with`."""

    def __init__(self, path: Path, reader: BagReader, cut: Words | None) -> None:
        """Use `open_bag` to make one."""
        self.path = path
        self.cut = cut
        """What is missing, None for a whole bag."""
        self.start_ns = reader.start_ns
        self.end_ns = reader.end_ns
        """Unix time of the first and of the last message; equal in an empty bag."""
        self.messages_count = reader.message_count
        self._reader = reader
        self._topics = {
            (each.topic, each.msgtype): _topic(each, reader.distro) for each in reader.connections
        }

    @property
    def name(self) -> str:
        """The name of the folder or file."""
        return self.path.stem if self.path.suffix in SUFFIXES else self.path.name

    @property
    def damage(self) -> Words | None:
        """What has been left out so far as unreadable; grows while messages are read."""
        lost = self._reader.lost
        if not lost:
            return None
        first_ns = min(each.at_ns for each in lost)
        return say(
            "{path} is damaged: messages lost: {messages}, damaged places: {places}, the first "
            "{seconds:.1f} s after the beginning. All others are played",
            path=self.path,
            messages=sum(each.messages for each in lost),
            places=len(lost),
            seconds=max(0, first_ns - self.start_ns) / 1e9,
        )

    @property
    def topics(self) -> tuple[TopicInBag, ...]:
        """Every topic, sorted by name."""
        return tuple(sorted(self._topics.values(), key=lambda topic: topic.name))

    @property
    def length_s(self) -> float:
        """Seconds from the first message to the last."""
        return (self.end_ns - self.start_ns) / 1e9

    def messages(
        self, start_ns: int | None = None, names: Collection[str] = ()
    ) -> Iterator[tuple[TopicInBag, int, bytes]]:
        """Yield topic, unix time in nanoseconds and raw message in the order of their times.

        `names`: of which topics, all if empty. Damaged chunks of an MCAP file are left out, see
        `damage`; raises BagError if a bag of another kind turns out to be damaged.
        """
        wanted = [each for each in self._reader.connections if not names or each.topic in names]
        try:
            for connection, stamp_ns, raw in self._reader.messages(start_ns, wanted):
                yield self._topics[connection.topic, connection.msgtype], stamp_ns, bytes(raw)
        except GeneratorExit:
            raise
        except Exception as error:
            raise unreadable(self.path, error) from error

    def on_this_thread(self) -> Bag:
        """Return a bag that this thread may read: sqlite3 is bound to the thread that opened it."""
        if not any(self.path.glob("*.db3")) and self.path.suffix != ".db3":
            return self
        self.close()
        return open_bag(self.path)

    def close(self) -> None:
        """Let go of the files."""
        self._reader.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def open_bag(path: Path) -> Bag:
    """Open a bag. Raises BagError with words that name the file and the fix."""
    from graph.bag.files import CutFiles, WholeBag

    files = files_of(path)
    path = path.parent if path.name == METADATA else path
    mcaps = [file for file in files if file.suffix == ".mcap"]
    reason: Exception | None = None
    if (path / METADATA).exists() or len(mcaps) < 2:
        try:
            return Bag(path, WholeBag(path if (path / METADATA).exists() else files[0]), None)
        except Exception as error:
            if not mcaps or isinstance(error, PermissionError):
                raise _unreadable(path, files, error) from error
            reason = error
    try:
        cut = CutFiles(mcaps)
    except Exception as error:
        foreign = isinstance(error, (OSError, ValueError, struct.error))
        raise _unreadable(path, files, reason if reason and foreign else error) from error
    return Bag(path, cut, cut.missing(path))


def _unreadable(path: Path, files: list[Path], error: Exception) -> BagError:
    """Return why no reader accepts the files, judged by their first bytes if possible."""
    with suppress(OSError):
        reason = defect_of(path, files, metadata_of(path))
        if reason:
            return BagError(say("{path} cannot be read: {reason}", path=path, reason=reason))
    return unreadable(path, error)


def files_of(path: Path) -> list[Path]:
    """Return the files that hold messages, without opening any.

    Raises BagError if there are none, or none that can be read.
    """
    try:
        return _files(path)
    except OSError as error:
        raise unreadable(path, error) from error


def _files(path: Path) -> list[Path]:
    path = path.parent if path.name == METADATA else path
    if not path.exists():
        raise no_bag(path, say("there is no such file or folder"))
    if path.is_file():
        if path.suffix not in SUFFIXES:
            raise no_bag(path, say("the name ends neither in .mcap nor in .db3"))
        return [path]
    if not path.is_dir():
        raise no_bag(path, say("it is neither a file nor a folder"))
    metadata = metadata_of(path)
    storage = metadata.get("storage_identifier", "mcap")
    if storage not in STORAGES:
        raise unknown_storage(path, storage)
    found = sorted(file for file in path.iterdir() if file.suffix in SUFFIXES)
    if not found and not metadata.get("relative_file_paths"):
        raise no_bag(path, say("it has neither metadata.yaml nor an .mcap file"))
    return found


def unknown_storage(path: Path, storage: object) -> BagError:
    """Return the error for a kind of storage that Deck does not read."""
    return BagError(
        say(
            "{path}: storage {storage!r} is not known, only mcap and sqlite3; convert it: "
            "`ros2 bag convert`",
            path=path,
            storage=str(storage),
        )
    )


def metadata_of(folder: Path) -> Mapping[str, Any]:
    """Return the content of metadata.yaml; nothing if it is missing or broken: readers say more."""
    import yaml

    try:
        found = read_yaml((folder / METADATA).read_text(encoding="utf-8"))
        inner = found["rosbag2_bagfile_information"]
    except (OSError, yaml.YAMLError, KeyError, TypeError, ValueError):
        return {}
    return inner if isinstance(inner, Mapping) else {}


def _topic(connection: Connection, distro: str) -> TopicInBag:
    from rosbags.interfaces import MessageDefinitionFormat

    definition = connection.msgdef
    kind = TypeText(
        connection.msgtype,
        definition.data,
        definition.format is MessageDefinitionFormat.IDL,
        "" if definition.data else distro,
    )
    offers = getattr(connection.ext, "offered_qos_profiles", ())
    reliability = offers[0].reliability.name.lower() if offers else ""
    durability = offers[0].durability.name.lower() if offers else ""
    return TopicInBag(connection.topic, kind, connection.msgcount, reliability, durability)
