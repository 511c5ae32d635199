"""The default time-outs."""

ANSWER_WITHIN_S = 5.0
"""Of a service, and for each step of a goal: found, accepted, agreed to cancel, the result."""
