"""The terminal as it really is: what is written to it, and the keys that come from it."""
