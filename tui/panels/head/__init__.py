"""The panel of the head: where it looks, and what it was told."""
