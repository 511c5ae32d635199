"""Updates on their way to the screen: only what has changed since the one before goes over.

A list that is as before is left out. Topics change a little all the time: a row that is as before
is its place among the rows before, and one with the same endpoints that place and the rest.
"""

from __future__ import annotations

from dataclasses import fields, replace
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from graph.data import GraphUpdate, TopicRow

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import Sample

LISTS = tuple(
    each.name
    for each in fields(GraphUpdate)
    if each.name not in ("time_s", "topics", "samples", "error", "old_since_s")
)
"""The fields that are sent when they change."""
ENDS = ("published_by", "subscribed_by")
_LIGHT = tuple(each.name for each in fields(TopicRow) if each.name not in ENDS)
_light = attrgetter(*_LIGHT)

Shortened = tuple[float, str, "Mapping[str, tuple[Sample, ...]]", dict[str, Any], "list[Any] | None"]
"""Time, error and samples as they are; the lists that have changed; the topics, if they have."""


class Shortener:
    """Leaves out what has not changed; every update that it is given must be sent."""

    def __init__(self) -> None:
        self._last = GraphUpdate(0.0)
        self._places: dict[str, int] = {}

    def shortened(self, update: GraphUpdate) -> Shortened:
        last, self._last = self._last, update
        changed = {name: now for name in LISTS if (now := getattr(update, name)) != getattr(last, name)}
        topics = [self._row(row, last.topics) for row in update.topics]
        as_before = topics == list(range(len(last.topics)))
        self._places = {row.name: place for place, row in enumerate(update.topics)}
        return update.time_s, update.error, update.samples, changed, None if as_before else topics

    def _row(self, row: TopicRow, before: tuple[TopicRow, ...]) -> Any:  # noqa: ANN401
        place = self._places.get(row.name)
        if place is None:
            return row
        old = before[place]
        # Endpoints that are equal may be others: what tells them apart is not compared.
        if row.published_by is not old.published_by or row.subscribed_by is not old.subscribed_by:
            return row
        return place if row == old else (place, _light(row))


class Lengthener:
    """Puts updates together again; what has not changed is the same object as before."""

    def __init__(self) -> None:
        self._last = GraphUpdate(0.0)

    def update(self, short: Shortened) -> GraphUpdate:
        time_s, error, samples, changed, topics = short
        last = self._last
        rows = last.topics if topics is None else tuple(self._row(each) for each in topics)
        self._last = replace(last, time_s=time_s, error=error, samples=samples, topics=rows, **changed)
        return self._last

    def _row(self, short: Any) -> TopicRow:  # noqa: ANN401
        if isinstance(short, TopicRow):
            return short
        if isinstance(short, int):
            return self._last.topics[short]
        place, values = short
        return _lengthened(values, self._last.topics[place])


def _lengthened(values: tuple[Any, ...], before: TopicRow) -> TopicRow:
    # The constructor of a frozen class of so many fields costs four times as much.
    row = object.__new__(TopicRow)
    row.__dict__.update(zip(_LIGHT, values, strict=True))
    row.__dict__.update(published_by=before.published_by, subscribed_by=before.subscribed_by)
    return row
