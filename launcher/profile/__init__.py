"""Profiles: from YAML to plain data that can be started (`spec`), each fault with its place."""
