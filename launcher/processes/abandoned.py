"""The time-outs for ending processes whose supervisor is gone."""

KILLED_AFTER_S = 0.7
"""From SIGINT to SIGKILL: with the search around it less than the 2 s of the promise."""
LEFT_AFTER_S = 10.0
"""After that a process that SIGKILL does not end is left to the kernel."""
