"""Profiles: from YAML to plain data that can be started, with the position of every error.

Other packages use `load.load_profile`, the only way to load a profile, `catalog` to list the
profiles, `defaults` for where they are, and `serial_choice` to look at devices before a start. What may
be written is declared in `node` and `model` alone; a `node.Node` is also what the supervisor obeys.
"""
