"""`deck record`: topics of the running robot into a folder that `ros2 bag` and Foxglove read.

With `--json` it writes one object per line, distinguished by `event`:

    recording   the first one: folder, domain
    status      each second: seconds, messages, bytes, bytes_per_s, lost, topics
    summary     the last one: the same with exit_code, complaints, and of each topic its type,
                messages, bytes and lost
"""

from __future__ import annotations

import math
import sys
import threading
import time
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cli.commands import Parser, command
from cli.domains import beyond_this_machine, running_domain
from cli.options import add_graph, add_json, folder, seconds
from graph.bag.errors import BagError
from graph.heavy_types import IMAGES, POINT_CLOUD
from launcher.errors import UsageError
from launcher.processes.ending import stop_by_signals
from launcher.rundir import new_recording
from text.i18n import _, localized
from text.output import BOLD, Paint, json_text, keep_stdout_to_ourselves, table, write
from text.plain import plain
from text.ros_names import TOPIC_NAME
from text.sentences import say
from tui.recording.words import complaints, progress, size_words

if TYPE_CHECKING:
    from graph.recording.recorder import Recorder, RecordingStatus

TOLD_S = 1.0


def _record_options(parser: Parser) -> None:
    parser.add_argument("topics", nargs="*", metavar=_("TOPIC"), help=_("what to record; all topics by default"))
    parser.add_argument("--hidden", action="store_true", help=_("hidden topics too: feedback and status of actions"))
    parser.add_argument("--no-images", dest="images", action="store_false", help=_("all topics without pictures"))
    parser.add_argument("--no-clouds", dest="clouds", action="store_false", help=_("all topics without point clouds"))
    parser.add_argument(
        "-o",
        "--output",
        metavar=_("FOLDER"),
        type=folder,
        help=_(
            "a new folder to record into; by default in DECK_RECORDINGS_DIR, else "
            "~/deck-recordings, named after lesson and time"
        ),
    )
    parser.add_argument("--for", dest="seconds", metavar="S", type=seconds, help=_("stop after S seconds"))
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    add_json(parser)
    parser.epilog = _(
        "Exit code: 0 if the recording is complete, 1 if it broke off or no messages "
        "arrived, 2 if it could not start."
    )


@command("record", _record_options)
def record_command(options: Namespace) -> int:
    """Record until stopped; return 0 if the bag is complete and not empty."""
    from graph.recording.recorder import Recorder

    topics = [_topic(name) for name in options.topics]
    what, domain, discovery = running_domain(options.domain, options.discovery)
    without = (frozenset() if options.images else IMAGES) | (frozenset() if options.clouds else {POINT_CLOUD})
    folder = Path(options.output) if options.output else new_recording(what)
    recorder = Recorder(domain, discovery, folder, topics or None, hidden=options.hidden, without=without)
    stop = stop_by_signals()
    keep_stdout_to_ourselves()
    try:
        recorder.start()
    except BagError as error:
        raise UsageError(error.words) from error
    try:
        _begin(folder, domain, as_json=options.json)
        _tell_until(recorder, stop, options)
    finally:
        status = recorder.stop()
    return _end(status, beyond_this_machine(discovery), as_json=options.json)


def _topic(name: str) -> str:
    """Return the full name of a topic; raises UsageError if it is invalid."""
    full = f"/{name.lstrip('/')}"
    if not TOPIC_NAME.fullmatch(full):
        raise UsageError(say("{name!r} is not a valid topic name; write it as /sensor/sonar_front", name=name))
    return full


def _begin(folder: Path, domain: int, *, as_json: bool) -> None:
    if as_json:
        _object("recording", folder=str(folder), domain=domain)
        return
    words = _("recording domain {domain} into {folder}; Ctrl-C ends it")
    write(words.format(domain=domain, folder=plain(str(folder))))


def _tell_until(recorder: Recorder, stop: threading.Event, options: Namespace) -> None:
    """Report progress every second, until it is stopped, fails, or its time is over."""
    deadline_s = time.monotonic() + (math.inf if options.seconds is None else options.seconds)
    while not (recorder.status.error or stop.is_set()):
        left_s = deadline_s - time.monotonic()
        if left_s <= 0 or stop.wait(min(left_s, TOLD_S)):
            return
        status = recorder.status
        if options.json:
            _object("status", **_figures(status), topics=len(status.topics))
        else:
            write(progress(status))


def _end(status: RecordingStatus, hint: str, *, as_json: bool) -> int:
    """Report the result, with the hint where nothing came; return the exit code."""
    found = list(complaints(status))
    if not status.messages and not status.error:
        found.append(_("nothing was recorded: nobody has published anything"))
        found += [localized(hint)] if hint else []
    code = 1 if status.error or not status.messages else 0
    if as_json:
        rows = [vars(row) for row in status.topics]
        _object("summary", **_figures(status), exit_code=code, complaints=found, topics=rows)
        return code
    _table(status)
    for sentence in found:
        write(sentence)
    write(_("{folder}: {words}").format(folder=plain(status.folder), words=progress(status)))
    if status.messages:
        write(_("to see it: deck replay {folder}").format(folder=plain(status.folder)))
    return code


def _table(status: RecordingStatus) -> None:
    head = (_("TOPIC"), _("TYPE"), _("MESSAGES"), _("SIZE"), _("LOST"))
    rows: Sequence[Sequence[str]] = [
        (row.name, row.type_name, str(row.messages), size_words(row.bytes), str(row.lost))
        for row in sorted(status.topics, key=lambda row: row.name)
    ]
    if rows:
        first, *others = table(head, rows)
        write("")
        write(Paint(sys.stdout)(first, BOLD))
        for line in others:
            write(line)


def _figures(status: RecordingStatus) -> dict[str, object]:
    return {
        "seconds": round(status.seconds, 3),
        "messages": status.messages,
        "bytes": status.bytes,
        "bytes_per_s": round(status.bytes_per_s),
        "lost": status.lost,
    }


def _object(event: str, **fields: object) -> None:
    write(json_text({"event": event, **fields}))
