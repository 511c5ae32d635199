"""`python -m tui` is `deck`."""

import sys

from tui.cli import main

sys.exit(main())
