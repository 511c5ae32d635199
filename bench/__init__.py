"""Measurements, with the things compared in the same run; nothing here is a test."""

import atexit
import os
import shutil
import tempfile

if "DECK_STATE_DIR" not in os.environ:
    # An emergency stop that is measured must not stay in force for the user's robot.
    os.environ["DECK_STATE_DIR"] = tempfile.mkdtemp(prefix="deck-bench-")
    atexit.register(shutil.rmtree, os.environ["DECK_STATE_DIR"], ignore_errors=True)
