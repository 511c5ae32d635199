"""The time-outs for ending processes whose supervisor is gone."""

KILLED_AFTER_S = 0.7
"""From SIGINT to SIGKILL: together with the search, less than the promised 2 s."""
LEFT_AFTER_S = 10.0
"""After this time a process that SIGKILL does not end is left to the kernel."""
