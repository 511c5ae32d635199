"""`python -m ros2`."""

from __future__ import annotations

import sys

from ros2.main import main
from text.i18n import detect, set_language

if __name__ == "__main__":
    set_language(detect())
    sys.exit(main(sys.argv[1:]))
