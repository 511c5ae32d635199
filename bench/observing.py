"""Deck's observer on the load, without a screen: all topics measured, one echoed.

`python -m bench.observing DOMAIN PERIOD_S` answers each line on stdin with its rates, as JSON. With
a third argument `idle` nothing is measured or echoed.
"""

from __future__ import annotations

import json
import sys

from bench.load import FLOATS, RATES_HZ
from graph.data import GraphUpdate
from graph.observer.observer import Observer


def main() -> None:
    """Observe until stdin is closed."""
    newest = [GraphUpdate(0.0)]

    def take(update: GraphUpdate) -> None:
        newest[0] = update

    observer = Observer(int(sys.argv[1]), "localhost", float(sys.argv[2]))
    observer.start(take)
    if "idle" not in sys.argv:
        observer.measure(all_topics=True)
        observer.watch([FLOATS[0]])
    print("ready", flush=True)
    for _ in sys.stdin:
        rates = {row.name: row.hz or 0.0 for row in newest[0].topics if row.name in RATES_HZ}
        print(json.dumps(rates), flush=True)
    observer.stop()


if __name__ == "__main__":
    main()
