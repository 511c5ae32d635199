"""A message filled in as YAML, for publishing, for calls and for goals."""
