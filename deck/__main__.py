"""`python -m deck` is `deck`."""

import sys

from deck import main

sys.exit(main())
