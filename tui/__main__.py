"""`python -m tui` is the same as `deck`."""

import os
import sys

# `-m` has put the current folder first on the path, but its files are not part of Deck.
_HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # noqa: PTH100, PTH120
sys.path[:] = [_HERE, *(place for place in sys.path if place not in ("", os.getcwd(), _HERE))]  # noqa: PTH109

from cli import main  # noqa: E402

sys.exit(main())
