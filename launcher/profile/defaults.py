"""The defaults of a profile, for code that does not import the profile model."""

READY_WITHIN_S = 10.0
"""How long a node may take to become ready."""
