"""A recording in a few words: its duration, its size, and what is wrong with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _, decimal, localized, ngettext
from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from graph.recording.recorder import RecordingStatus

BETWEEN = " · "
LONGEST = 300
KILO = 1000.0
LOW_S = 300.0
"""Less remaining time than this is reported."""


def size_words(size_bytes: float) -> str:
    """Return `340 B`, `3.4 kB`, `12 MB`."""
    units = (_("B"), _("kB"), _("MB"), _("GB"), _("TB"))
    size, unit = float(size_bytes), 0
    while size >= KILO and unit < len(units) - 1:
        size, unit = size / KILO, unit + 1
    digits = 1 if unit and size < 10 else 0
    return decimal(f"{size:.{digits}f}") + f" {units[unit]}"


def rate_words(bytes_per_s: float) -> str:
    """Return `8.0 MB/s`."""
    return _("{size}/s").format(size=size_words(bytes_per_s))


def is_low(status: RecordingStatus) -> bool:
    """Return whether the disk will soon be full."""
    return status.left_s is not None and status.left_s < LOW_S


def low_words(status: RecordingStatus) -> str:
    """Return for how long the disk has room."""
    return _("the disk has room for {length}").format(length=length_words(status.left_s or 0.0))


def length_words(seconds: float) -> str:
    """Return `12 s`, `3:07` or `1:02:03`."""
    whole = int(seconds)
    if whole < 60:
        return _("{seconds} s").format(seconds=whole)
    hours, rest = divmod(whole, 3600)
    minutes = f"{rest // 60:02d}" if hours else str(rest // 60)
    return ":".join(([str(hours)] if hours else []) + [minutes, f"{rest % 60:02d}"])


def progress(status: RecordingStatus) -> str:
    """Return the progress in one line."""
    parts = [
        length_words(status.seconds),
        ngettext("{n} message", "{n} messages", status.messages).format(n=status.messages),
        size_words(status.bytes),
        ngettext("{n} topic", "{n} topics", len(status.topics)).format(n=len(status.topics)),
    ]
    if not status.ended:
        parts.insert(3, rate_words(status.bytes_per_s))
        if is_low(status):
            parts.append(low_words(status))
    if status.lost:
        parts.append(_("{n} lost").format(n=status.lost))
    if status.slow:
        parts.append(_("the disk does not keep up"))
    return BETWEEN.join(parts)


def complaints(status: RecordingStatus) -> Sequence[str]:
    """Return what is wrong with a recording, one sentence each; empty if all is well."""
    found = [plain(localized(status.error), LONGEST)] if status.error else []
    if status.dropped:
        words = ngettext(
            "{n} message is missing because the disk was too slow or full",
            "{n} messages are missing because the disk was too slow or full",
            status.dropped,
        )
        found.append(words.format(n=status.dropped))
    on_the_way = status.lost - status.dropped
    if on_the_way:
        words = ngettext(
            "{n} message was lost on the way: best effort, or too short a queue",
            "{n} messages were lost on the way: best effort, or too short a queue",
            on_the_way,
        )
        found.append(words.format(n=on_the_way))
    for topic, reason in status.skipped.items():
        words = _("{topic} is not recorded: {reason}")
        found.append(words.format(topic=plain(topic), reason=plain(localized(reason), LONGEST)))
    if status.absent:
        topics = ", ".join(plain(topic) for topic in status.absent)
        found.append(_("nobody has published {topics}").format(topics=topics))
    return found
