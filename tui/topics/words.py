"""A topic in sentences: what it is doing, who is on it, and what to do when nothing comes."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from rich.cells import cell_len

from graph.data import Trouble
from text.i18n import _, decimal, ngettext, said
from text.plain import plain
from tui.topics.figures import count_text, seconds_text
from tui.topics.qos_words import misfit_words
from tui.topics.table_columns import age_text, bandwidth_text, hz_text
from tui.widgets.trouble import no_data_words, trouble_words

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from graph.data import EndpointInfo, TopicRow

LONGEST = 400
KILO = 1000
SHOWN_NODES = 4
BETWEEN = " · "
OURSELVES = "Deck"


def advice(row: TopicRow) -> tuple[str, str]:
    """Why nothing can be shown of the topic, and the way out; both empty if there is no trouble."""
    if row.trouble is None:
        return "", _remark(row)
    if row.trouble is Trouble.QUIET and not row.publishers:
        return _("only Deck itself publishes here"), _what_deck_sent(row)
    return trouble_words(row.trouble, row.age_s), plain(_way_out(row, row.trouble), LONGEST)


def _way_out(row: TopicRow, trouble: Trouble) -> str:
    facts = row.facts
    if "recorded" in facts:
        return _("Nothing of it was recorded around here: go on, or jump.")
    if trouble is Trouble.NO_PUBLISHER:
        return _("Start the node that publishes it, or look for a misspelt or remapped name.")
    if trouble is Trouble.QUIET:
        return _("Publishers are there: {nodes}. Look at their logs.").format(
            nodes=names(row.published_by) or row.publishers
        )
    if trouble is Trouble.UNKNOWN_TYPE and "package" in facts:
        return _how_to_install(facts).format(**facts)
    if trouble is Trouble.QOS_MISMATCH and "policy" in facts:
        return misfit_words(facts)
    return said(row.detail)


def _how_to_install(facts: Mapping[str, str]) -> str:
    if "pip" in facts:
        return _(
            "{type}: install {package} by `pip install {pip}`, `apt install {apt}` or `pixi add "
            "{pixi}`, or source the workspace that has it."
        )
    if "apt" in facts:
        return _(
            "{type}: install {package} by `apt install {apt}` or `pixi add {pixi}`, or source the "
            "workspace that has it."
        )
    return _("{type}: install the package {package}, or source the workspace that has it.")


def _what_deck_sent(row: TopicRow) -> str:
    return _("It has sent nothing yet.") if row.age_s is None else no_data_words(row.age_s)


def _remark(row: TopicRow) -> str:
    if "types" in row.facts:
        words = _("Peers disagree about the type: {types}; shown is {shown}.")
        return plain(words.format(**row.facts), LONGEST)
    return plain(row.detail, LONGEST)


def figures(row: TopicRow, size_bytes: int | None) -> list[str]:
    """Rate, bandwidth, age, jitter, latency, losses and size; why there are none if so."""
    if not row.measured:
        parts = [_("not measured: Deck is not subscribed")]
    elif row.trouble is Trouble.QUIET and row.age_s is not None:
        parts = [no_data_words(row.age_s)]
    elif row.hz is None:
        parts = [_("no rate yet: it takes two messages")] if row.trouble is None else []
    else:
        parts = [
            f"{hz_text(row.hz)} {_('Hz')}",
            bandwidth_text(row.bytes_per_s),
            _("age {time}").format(time=age_text(row.age_s)),
            _("jitter {time}").format(time=seconds_text(row.jitter_s)),
            _("latency {time}").format(time=seconds_text(row.latency_s)),
            _("lost {n}").format(n=count_text(row.lost)),
        ]
    if size_bytes is not None:
        parts.append(_("{size} a message").format(size=size_text(size_bytes)))
    return parts


def packed(parts: Sequence[str], width: int) -> list[str]:
    """The parts in lines of at most so many cells, each line as full as can be."""
    lines: list[str] = []
    for part in parts:
        if lines and cell_len(lines[-1]) + len(BETWEEN) + cell_len(part) <= width:
            lines[-1] += BETWEEN + part
        else:
            lines.append(part)
    return lines


def size_text(size_bytes: int) -> str:
    """A size with three figures and its unit."""
    if size_bytes < KILO:
        return _("{n} B").format(n=size_bytes)
    if size_bytes < KILO * KILO:
        return _("{n} kB").format(n=decimal(f"{size_bytes / KILO:.1f}"))
    return _("{n} MB").format(n=decimal(f"{size_bytes / KILO / KILO:.1f}"))


def ends(row: TopicRow) -> str:
    """Who publishes and who listens, by their names where they are known."""
    publishers = names(row.published_by, counted=True)
    if not publishers and (row.publishers or not row.own_publishers):
        publishers = ngettext("{n} publisher", "{n} publishers", row.publishers).format(
            n=row.publishers
        )
    if row.own_publishers:
        publishers = f"{publishers}, {OURSELVES}" if publishers else OURSELVES
    subscribers = names(row.subscribed_by, counted=True) or ngettext(
        "{n} subscriber", "{n} subscribers", row.subscribers
    ).format(n=row.subscribers)
    return f"{publishers} → {subscribers}"


def names(endpoints: Sequence[EndpointInfo], *, counted: bool = False) -> str:
    """The nodes of these endpoints, each once, without the slash of the root namespace.

    `counted`: with the number of its endpoints where there are several, as beside their sum.
    """
    found = Counter(plain(end.node.removeprefix("/"), LONGEST) for end in endpoints)
    several = {name: f" ×{count}" for name, count in found.items() if counted and count > 1}
    shown = [name + several.get(name, "") for name in found][:SHOWN_NODES]
    more = len(found) - len(shown)
    return ", ".join(shown) + (f" +{more}" if more else "")
