"""Deck's recorder on the load, without a screen.

`python -m bench.recorders.deck DOMAIN FOLDER` answers each line on stdin with the number of
messages in the bag so far.
"""

from __future__ import annotations

import sys
from pathlib import Path

from graph.recording.recorder import Recorder


def main() -> None:
    """Record until stdin is closed."""
    recorder = Recorder(int(sys.argv[1]), "localhost", Path(sys.argv[2]))
    recorder.start()
    print("ready", flush=True)
    for _line in sys.stdin:
        print(recorder.status.messages, flush=True)
    recorder.stop()


if __name__ == "__main__":
    main()
