"""What counts where a profile says nothing, for whoever does without the model of profiles."""

READY_WITHIN_S = 10.0
"""How long a node may take until it is ready."""
