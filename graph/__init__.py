"""The ROS graph as plain data: topics, rates, samples and calls, with no widget in sight."""

import logging

# Else Python writes warnings on stderr, and that is a screen.
logging.getLogger(__name__).addHandler(logging.NullHandler())
