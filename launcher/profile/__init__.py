"""Profiles: from YAML to plain data that can be started, with the position of every error.

Other packages use `load.load_profile`, the only way to load a profile, `catalog` to list the
profiles, and the names of the format (`panels`, `devices`, `defaults`). Fields are declared in
`model` and nowhere else.
"""
