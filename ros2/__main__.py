"""`python -m ros2`."""

from __future__ import annotations

import sys

from ros2.main import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
