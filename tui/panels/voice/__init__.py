"""The panel of the voice: what human and robot say."""
