"""The ROS graph as plain data: topics, rates, samples and calls, with no widget in sight.

From other rooms: `data` (what is told), `observer` and `replay` (who tells it), `recording`, and of
`bag`, `calls`, `messages`, `pictures` and `publishing` what their own words here say. ROS is loaded
by opening an observer or a recorder, not by importing them.
"""

import logging

# Else Python writes warnings on stderr, and that is a screen.
logging.getLogger(__name__).addHandler(logging.NullHandler())
