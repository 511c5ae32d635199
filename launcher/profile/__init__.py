"""Profiles: from YAML to plain data that can be started, every error with its position.

From outside: `load.load_profile`, the only way to a profile, `catalog` for which there are, and
names of the format (`panels`, `devices`, `defaults`). A field is declared in `model` and nowhere
else.
"""
