"""The Voice panel: what human and robot say."""
