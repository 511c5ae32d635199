"""The ROS graph as plain data: topics, rates, samples and calls, with no widget in sight.

Other rooms may import `data` (the plain data itself), `observer` and `replay` (its sources),
`recording`, and those parts of `bag`, `calls`, `messages`, `pictures` and `publishing` that their
own docstrings name; `housekeeping` and `qos`, which are plain too; and `ros` to open a
node. ROS is loaded by opening an observer, a recorder or a node, not by importing them.
"""

import logging

# Otherwise Python would print warnings to stderr, which is the screen.
logging.getLogger(__name__).addHandler(logging.NullHandler())
