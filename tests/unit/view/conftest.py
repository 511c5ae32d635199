"""What is drawn is made of Rerun's own shapes: without it there is nothing to test."""

from __future__ import annotations

from importlib.util import find_spec

collect_ignore = [] if find_spec("rerun") else ["test_scene.py"]
"""`make view` installs it, for Python 3.11 and newer."""
