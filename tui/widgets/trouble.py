"""Why a topic shows nothing, in words, and the fix: four troubles, four messages."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from graph.data import EndpointInfo, TopicRow, Trouble
from text.figures import elapsed
from text.i18n import N_, _, localized
from text.plain import plain

if TYPE_CHECKING:
    from graph.qos import Mismatch

LONGEST = 400
SHOWN_NODES = 4

# Where there is little room only their beginning is seen: it holds the "no".
_HEADLINES = {
    Trouble.NO_PUBLISHER: N_("nobody publishes this topic"),
    Trouble.QOS_MISMATCH: N_("QoS is incompatible: not everybody is heard"),
    Trouble.UNKNOWN_TYPE: N_("unknown type: the message type is not installed"),
    Trouble.QUIET: N_("no message has arrived yet, though there is a publisher"),
}


def trouble_words(trouble: Trouble, age_s: float | None = None) -> str:
    """The headline for an empty panel; `age_s` is the age of the newest message, if any."""
    if trouble is Trouble.QUIET and age_s is not None:
        return no_data_words(age_s)
    return _(_HEADLINES[trouble])


def no_data_words(age_s: float) -> str:
    """Say for how long nothing has arrived: in seconds, from two minutes on in minutes."""
    if age_s < 120:
        return _("no data for {seconds} s").format(seconds=elapsed(age_s))
    return _("no data for {minutes} min").format(minutes=elapsed(age_s / 60))


def lost_words() -> tuple[str, str]:
    """Say why no raw picture of another machine comes, and the fix."""
    return (
        _("no whole picture comes over the network"),
        _(
            "Raw pictures take hundreds of packets each, and with any of them the whole is lost; "
            "or the camera is silent. A session of Deck on that machine sends them small, or "
            "image_transport compressed."
        ),
    )


def advice(row: TopicRow) -> tuple[str, str]:
    """Why the topic cannot be shown, and the fix; both empty if there is no trouble."""
    if row.trouble is None:
        return "", plain(localized(row.detail), LONGEST)
    if row.trouble is Trouble.QUIET and row.raw_from_afar:
        return lost_words()
    if row.trouble is Trouble.QUIET and not row.publishers:
        sent = _("It has sent nothing yet.") if row.age_s is None else no_data_words(row.age_s)
        return _("only Deck itself publishes here"), sent
    return trouble_words(row.trouble, row.age_s), plain(_way_out(row, row.trouble), LONGEST)


def _way_out(row: TopicRow, trouble: Trouble) -> str:
    if trouble is Trouble.NO_PUBLISHER and not row.recorded:
        return _("Start the node that publishes it, or look for a misspelt or remapped name.")
    if trouble is Trouble.QUIET and not row.recorded:
        return _("Publishers are there: {nodes}. Look at their logs.").format(
            nodes=names(row.published_by) or row.publishers
        )
    return localized(row.detail)


def pair_words(pair: Mismatch) -> str:
    """Who does not hear whom, and the two fixes."""
    return plain(f"{localized(pair.what)} {localized(pair.mend)}", LONGEST)


def listeners(row: TopicRow | None) -> list[str]:
    """Return who hears a topic, all in one text; nothing if nobody does."""
    return [names(row.subscribed_by) or str(row.subscribers)] if row is not None and row.subscribers else []


def names(endpoints: Sequence[EndpointInfo], *, counted: bool = False) -> str:
    """The nodes of these endpoints, each once, without the slash of the root namespace.

    `counted`: with the number of endpoints of each node that has several.
    """
    found = Counter(plain(localized(end.called).removeprefix("/"), LONGEST) for end in endpoints)
    several = {name: f" ×{count}" for name, count in found.items() if counted and count > 1}
    shown = [name + several.get(name, "") for name in found][:SHOWN_NODES]
    more = len(found) - len(shown)
    return ", ".join(shown) + (f" +{more}" if more else "")
