"""Measurements, side by side in one run; nothing here is a test."""

import atexit
import os
import shutil
import tempfile

if "DECK_STATE_DIR" not in os.environ:
    # A stop that is measured must not hold anybody's robot afterwards.
    os.environ["DECK_STATE_DIR"] = tempfile.mkdtemp(prefix="deck-bench-")
    atexit.register(shutil.rmtree, os.environ["DECK_STATE_DIR"], ignore_errors=True)
