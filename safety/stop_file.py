"""The emergency stop on disk: one small file per domain, from the stop until its release.

Every node that obeys the stop writes it, reads it at its start, and watches it, and so does the
supervisor for a screen: a stop outlives its sender, every node and a power failure, and needs no
middleware to reach the nodes of this computer. What was released stays in a second file beside it
(`7.released` beside `7`), so that a file that is removed by anything else releases nothing. Both
are replaced as a whole, through a temporary file beside them. A stop that cannot be read is a stop:
when in doubt nothing moves.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from platformdirs import user_state_path

from safety.known_stops import KnownStops
from safety.stop_record import Stop, StopRecord, read_record
from text.i18n import N_
from text.nested import read_json
from text.os_words import os_reason

STATE_DIR = "DECK_STATE_DIR"
"""Environment variable with the folder of Deck's saved state."""


def stop_place(domain: int) -> Path:
    """Return a file in `$DECK_STATE_DIR`, `$XDG_STATE_HOME/deck` or `~/.local/state/deck`.

    Raises:
        RuntimeError: if this user has no home directory.
    """
    chosen = os.environ.get(STATE_DIR)
    state = Path(chosen) if chosen else user_state_path("deck")
    return state / "stops" / str(domain)


_LONGEST = 8192
_ALONE_WITHIN_S, _AGAIN_S = 0.05, 0.001
"""How long to wait for another process that changes the files, and how often to try."""
_NO_SENSE = (OSError, ValueError, TypeError, KeyError, AttributeError, ArithmeticError, RecursionError)


PASSED_EVERY_S = 0.5
"""How often to pass on what is heard: a stop may be repeated at any rate, and writing takes
milliseconds."""
NOT_PASSED = N_("The emergency stop cannot be written to disk ({problem}): a node that has not heard it may move on")
TOPIC, BY_SCREEN = "topic", "screen"
"""What has engaged a stop: a message, or somebody by no topic."""


class KeptStop(NamedTuple):
    """What is known of an emergency stop that is in effect."""

    since_s: float
    """Unix time."""
    by: str
    """What engaged it: `topic`, `pico` or `screen`."""
    publishers: str = ""
    """Full names of the nodes that could have sent it on the topic, separated by blanks."""
    remembered: bool = False
    """Whether it comes from before the start of this node."""
    unreadable: str = ""
    """Why nothing more is known about it."""


class SavedStop(NamedTuple):
    """What the disk says."""

    record: StopRecord
    stop: KeptStop | None
    """The stop that is in effect, None if there is none."""
    written_ns: int = 0
    """When all that holds was known on this computer, Unix time."""


class StopFile:
    """The saved stop of one domain."""

    def __init__(self, domain: int, writer: str) -> None:
        """`writer` is the full name of the node."""
        self._domain = domain
        self._paths: tuple[str, str] | None = None
        self._draft = f".{domain}{writer.replace('/', '.')}"
        self._unknown: Stop | None = None
        """Stands for the stop that may be in a file of which nothing is known."""

    def signature(self) -> tuple[object, ...]:
        """Return what changes with every change of the files; costs no reading."""
        if self._paths is None:
            try:
                place = self._place()
            except RuntimeError:
                return ()
            self._paths = (str(place), str(_released(place)))
        return tuple(map(_look, self._paths))

    def read(self) -> SavedStop:
        """Return what is saved; nothing if this user has no place for it."""
        try:
            place = self._place()
        except RuntimeError:
            return SavedStop(StopRecord(), None)
        return self._read(place, _parse_released(_released(place)))

    def _read(self, path: Path, record: StopRecord) -> SavedStop:
        """Read a file of a stop; `record` has what was released."""
        try:
            stops, stop, written_ns = _parse(_bytes(path))
        except FileNotFoundError:
            self._unknown = None
            return SavedStop(record, None)
        except _NO_SENSE as error:
            unread = self._unread(path)
            stops, written_ns = frozenset({unread}), unread.said_ns
            stop = KeptStop(time.time(), "", remembered=True, unreadable=os_reason(error))
        record = record.stopped(*stops)
        return SavedStop(record, stop if record.engaged else None, written_ns)

    def keep(self, stop: KeptStop, record: StopRecord, *, whole: bool = True) -> str:
        """Save what `record` holds; return why that failed.

        Not if it is saved already, or, unless it is to be saved as a `whole`, some of it.
        """
        if not _is_missing(record, self.read(), whole=whole):
            return ""
        try:
            with self._alone():
                saved = self.read()
                if _is_missing(record, saved, whole=whole):
                    first = stop if saved.stop is None or saved.stop.unreadable else saved.stop
                    self._write(record.merged(saved.record), first)
        except (OSError, RuntimeError) as error:
            return os_reason(error)
        return ""

    def forget(self, record: StopRecord) -> str:
        """Save what is released, and remove the stop unless it is a newer one; say why not."""
        try:
            place = self._place()
            gone = _parse_released(_released(place))
            is_saved = gone.merged(record) == gone and not os.path.lexists(place)
            if is_saved or not record.released:
                return ""
            with self._alone():
                saved = self.read().record
                known = record.merged(saved)
                if known.released != saved.released:
                    self._write(known, None)
                if not self.read().record.engaged:
                    self._remove(place, known)
        except (OSError, RuntimeError) as error:
            return os_reason(error)
        return ""

    def _remove(self, place: Path, record: StopRecord) -> None:
        """Remove the file, and give back a stop that others have put there without waiting."""
        taken = place.with_name(f"{self._draft}.taken")
        with contextlib.suppress(FileNotFoundError):
            place.replace(taken)
            found = self._read(taken, record)
            known = found.record.merged(self.read().record)
            if found.stop is not None and known.engaged:
                self._write(known, found.stop)
            taken.unlink()
            _flush(place.parent)

    @contextlib.contextmanager
    def _alone(self) -> Iterator[None]:
        """Change the files while no other process does.

        Whoever stands still while it does must not hold up a stop: nobody waits long.
        """
        folder = self._place().parent
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        flags = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC
        descriptor = os.open(folder, flags)
        try:
            until_s = time.monotonic() + _ALONE_WITHIN_S
            while not _locked(descriptor) and time.monotonic() < until_s:
                time.sleep(_AGAIN_S)
            yield
        finally:
            os.close(descriptor)

    def give(self, stop: Stop, by: str) -> str:
        """Add a stop for a program that is not a node; return why that failed."""
        return self.keep(KeptStop(time.time(), by), StopRecord().stopped(stop))

    def release(self, said_ns: int) -> str:
        """Release what was saved before this time for a program that is not a node.

        Return why that failed. It may have waited since it was said, by the clock of this computer.
        """
        known, saved = KnownStops(), self.read()
        known.learn(saved.record, saved.written_ns)
        if saved.stop is not None and saved.written_ns > time.time_ns():
            return self._date_anew(saved.stop)
        return self.forget(known.record.freed(known.before(said_ns)))

    def _date_anew(self, stop: KeptStop) -> str:
        """Write a stop from the future with the time of now: the clock was set back."""
        try:
            with self._alone():
                self._write(self.read().record, stop)
        except (OSError, RuntimeError) as error:
            return os_reason(error)
        return ""

    def _place(self) -> Path:
        return stop_place(self._domain)

    def _write(self, record: StopRecord, stop: KeptStop | None) -> None:
        """Write the file of a stop, or that of what was released."""
        place, ending, document = self._place(), ".released", dict[str, object]()
        if stop is not None:
            ending = ""
            document = {"since": stop.since_s, "by": stop.by, "publishers": stop.publishers}
            document["written_ns"] = time.time_ns()
        data = json.dumps({**document, **record.texts()}).encode()
        _replace(place.parent, f"{self._draft}{ending}", f"{place.name}{ending}", data)

    def _unread(self, place: Path) -> Stop:
        """Return the name of a stop of which nothing can be read, the same for all who see it."""
        with contextlib.suppress(OSError):
            return Stop(place.lstat().st_mtime_ns)
        self._unknown = self._unknown or Stop(time.time_ns())
        return self._unknown


def _is_missing(record: StopRecord, saved: SavedStop, *, whole: bool) -> bool:
    """Whether something of it is to be saved that nobody has released since."""
    missing = record.merged(saved.record).held - saved.record.held
    return bool(missing) and (whole or not record.held & saved.record.held)


def _locked(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:  # Another has it, or the file system knows no locks.
        return False
    return True


def _released(place: Path) -> Path:
    return place.with_name(f"{place.name}.released")


def _look(path: str) -> tuple[int, ...]:
    try:
        seen = os.lstat(path)
    except FileNotFoundError:
        return ()
    except OSError as error:
        return (error.errno or -1,)
    return (seen.st_ino, seen.st_mtime_ns, seen.st_ctime_ns, seen.st_size)


def _bytes(place: Path) -> bytes:
    with place.open("rb") as file:
        return file.read(_LONGEST)


def _parse(text: bytes) -> tuple[frozenset[Stop], KeptStop, int]:
    """Read the file of a stop, and when it was written.

    One of an older Deck has no name for the stop but its time, and no other time.
    """
    document = read_json(text)
    since_s = float(document["since"])
    written_ns = int(document.get("written_ns", since_s * 1e9))
    stop = KeptStop(since_s, str(document["by"]), str(document.get("publishers", "")), remembered=True)
    held = read_record(str(document.get("stops", "")), "").held
    return held or frozenset({Stop(int(since_s * 1e9))}), stop, written_ns


def _parse_released(place: Path) -> StopRecord:
    """Read what was released; what cannot be read releases nothing."""
    try:
        return read_record("", str(read_json(_bytes(place))["released"]))
    except _NO_SENSE:
        return StopRecord()


def _replace(folder: Path, draft: str, name: str, data: bytes) -> None:
    """Replace a file as a whole: seen at once by who watches it, and then flushed to disk.

    After a loss of power before that it may be empty, which is a stop, or releases nothing.
    """
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_NOFOLLOW | os.O_CLOEXEC
    with os.fdopen(os.open(folder / draft, flags, 0o600), "wb") as file:
        file.write(data)
        file.flush()
        (folder / draft).replace(folder / name)
        os.fsync(file.fileno())
    _flush(folder)


def _flush(folder: Path) -> None:
    """Flush it to disk: the power may fail at any moment."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
