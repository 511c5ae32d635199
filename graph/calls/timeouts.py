"""The default time-outs."""

ANSWER_WITHIN_S = 5.0
"""Of a service call, and of each step of a goal: found, accepted, agreed to cancel, result."""
